// docs/format-block.md, "Layers". Directions are in directions.cpp.
#include "plain_decoder/block_decoder.h"
#include "plain_decoder/directions.h"
#include "plain_decoder/value_map.h"

#include <bit>

namespace plain {

namespace {

class LayerReader {
 public:
  LayerReader(RangeDecoder& in, BlockState& block, const BlockLayer& layer,
              std::vector<Code>& codes)
      : in_(in), block_(block), surface_(block.surface), layer_(layer), codes_(codes) {}

  void read();

 private:
  bool is_direction() const { return layer_.kind == BlockLayer::Kind::Octahedral; }
  bool was_derived(std::uint32_t t) const { return layer_.is_normal && block_.was_derived[t]; }
  bool had_code(std::uint32_t corner) const;
  std::vector<std::uint32_t> corners_at(std::uint32_t v, const std::optional<Fan>& fan) const;
  std::size_t greatest_bend(const std::vector<std::uint32_t>& corners) const;
  void read_vertex(std::uint32_t v);
  void read_corner(std::uint32_t v, const std::vector<std::uint32_t>& corners, std::size_t i,
                   const std::optional<Fan>& fan);
  Code read_code_of_vertex(std::uint32_t v, const std::vector<std::uint32_t>& corners);
  Code read_new_code(const Code& like, const std::vector<std::uint32_t>& corners);
  Expected expected_code(const std::vector<std::uint32_t>& corners) const;
  void learn_misses(const Code& code, const Code& by_map, const Code& like);

  RangeDecoder& in_;
  BlockState& block_;
  const Surface& surface_;
  const BlockLayer& layer_;
  std::vector<Code>& codes_;
  std::vector<bool> is_known_;  // per corner
  std::optional<DirectionReader> directions_;

  BitsBy<2> have_one_code_, is_kept_;
  BitsBy<3> is_like_;
  BitsBy<1> is_of_grain_;
  std::array<Signed, kDoubts + 1> difference_;
  std::array<Signed, 4> difference_in_grains_;
  std::array<std::uint32_t, 2> misses_{};
};

bool LayerReader::had_code(std::uint32_t corner) const {
  return !block_.is_new(corner / 3) && !was_derived(corner / 3);
}

void LayerReader::read() {
  codes_.resize(3 * surface_.triangles.size());
  is_known_.assign(codes_.size(), false);
  for (std::uint32_t corner = 0; corner < codes_.size(); ++corner) {
    const std::uint32_t v = surface_.triangles[corner / 3][corner % 3];
    is_known_[corner] = had_code(corner) && !block_.is_split_or_root(v);
  }
  if (is_direction()) directions_.emplace(in_, block_, layer_.bits, codes_, is_known_);
  for (std::uint32_t v = 0; v < surface_.places.size(); ++v) read_vertex(v);
}

std::vector<std::uint32_t> LayerReader::corners_at(std::uint32_t v,
                                                   const std::optional<Fan>& fan) const {
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t t : fan ? fan->triangles : surface_.list(v)) {
    if (layer_.is_normal && block_.end.derived[t]) continue;
    const Triangle& c = surface_.triangles[t];
    corners.push_back(3 * t + (c[0] == v ? 0 : c[1] == v ? 1 : 2));
  }
  if (fan && fan->closed) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  }
  return corners;
}

std::size_t LayerReader::greatest_bend(const std::vector<std::uint32_t>& corners) const {
  std::size_t greatest = 0;
  for (std::size_t i = 1; i < std::min(corners.size(), kLongest); ++i) {
    greatest = std::max(greatest, surface_.bend(corners[i - 1] / 3, corners[i] / 3));
  }
  return greatest;
}

void LayerReader::read_vertex(std::uint32_t v) {
  const std::optional<Fan> fan = surface_.fan(v);
  const std::vector<std::uint32_t> corners = corners_at(v, fan);
  std::size_t unknown = 0;
  std::vector<Code> known;  // different ones
  for (const std::uint32_t corner : corners) {
    if (!is_known_[corner]) {
      ++unknown;
    } else if (std::find(known.begin(), known.end(), codes_[corner]) == known.end()) {
      known.push_back(codes_[corner]);
    }
  }
  if (unknown == 0) return;
  if (known.size() < 2 && have_one_code_[{known.size(), greatest_bend(corners)}].read(in_)) {
    const Code code = known.empty() ? read_code_of_vertex(v, corners) : known[0];
    for (const std::uint32_t corner : corners) {
      codes_[corner] = code;
      is_known_[corner] = true;
    }
    if (directions_) directions_->store(v, code);
    return;
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!is_known_[corners[i]]) read_corner(v, corners, i, fan);
  }
}

void LayerReader::read_corner(std::uint32_t v, const std::vector<std::uint32_t>& corners,
                              std::size_t i, const std::optional<Fan>& fan) {
  const std::uint32_t corner = corners[i], t = corner / 3;
  std::vector<Code> tried;
  const auto is_it = [&](std::size_t kind, std::size_t bend, const Code& code) {
    if (std::find(tried.begin(), tried.end(), code) != tried.end()) return false;
    const bool any_before = !tried.empty();
    tried.push_back(code);
    return is_like_[{kind, any_before, bend}].read(in_);
  };
  const auto is_found = [&]() -> std::optional<Code> {
    for (std::uint32_t other = 3 * t; other < 3 * t + 3; ++other) {
      if (other == corner || !is_known_[other]) continue;
      if (is_it(0, 0, codes_[other])) return codes_[other];
    }
    const std::size_t n = corners.size();
    for (const std::uint32_t beside : {corners[(i + n - 1) % n], corners[(i + 1) % n]}) {
      if (beside == corner || !is_known_[beside]) continue;
      if (is_it(1, surface_.bend(t, beside / 3), codes_[beside])) return codes_[beside];
    }
    if (had_code(corner) && is_it(2, 0, codes_[corner])) return codes_[corner];
    for (std::size_t k = 0; k < std::min(n, kLongest) && tried.size() < 6; ++k) {
      const std::uint32_t other = corners[k];
      if (!is_known_[other]) continue;
      if (is_it(3, surface_.bend(t, other / 3), codes_[other])) return codes_[other];
    }
    return std::nullopt;
  };
  if (const std::optional<Code> found = is_found()) {
    codes_[corner] = *found;
  } else if (directions_) {
    CornerDirection asked{.vertex = v, .corners = corners, .at = i};
    asked.is_fan = fan.has_value();
    asked.is_closed = fan && fan->closed;
    if (had_code(corner)) asked.had = codes_[corner];
    if (!tried.empty()) asked.tried = tried.front();
    codes_[corner] = directions_->read_of_corner(asked);
  } else {
    codes_[corner] = read_new_code(tried.empty() ? Code{} : tried.front(), {corner});
  }
  is_known_[corner] = true;
}

// "Code of a whole vertex".
Code LayerReader::read_code_of_vertex(std::uint32_t v, const std::vector<std::uint32_t>& corners) {
  std::optional<Code> had;
  for (const std::uint32_t corner : corners) {
    if (had_code(corner)) had = codes_[corner];
  }
  const bool is_new = v >= block_.coarse_vertices;
  if (had && is_kept_[{block_.vertices[v].moved, is_new}].read(in_)) return *had;
  if (directions_) return directions_->read_of_vertex(v, had);
  return read_new_code(had ? *had : Code{}, corners);
}

// "New code".
Code LayerReader::read_new_code(const Code& like, const std::vector<std::uint32_t>& corners) {
  Code code{};
  const bool is_lattice = layer_.kind == BlockLayer::Kind::Lattice;
  const Expected by_map = is_lattice ? expected_code(corners) : Expected{};
  const bool is_by_map = misses_[0] <= misses_[1];
  const Code& expected = is_by_map ? by_map.code : like;
  Signed& difference = difference_[is_by_map ? by_map.doubt : kDoubts];
  bool has_grain = false, expects_grain = true;
  for (std::size_t k = 0; k < layer_.numbers(); ++k) {
    has_grain = has_grain || layer_.grains[k] > 1;
    expects_grain = expects_grain && expected[k] % layer_.grains[k] == 0;
  }
  if (has_grain && is_of_grain_[{expects_grain}].read(in_)) {
    for (std::size_t k = 0; k < layer_.numbers(); ++k) {
      const std::int64_t grain = layer_.grains[k], raised = expected[k] + grain / 2;
      const std::int64_t nearest = raised / grain - (raised % grain < 0 ? 1 : 0);
      const std::int64_t grains =
          sum_of(static_cast<std::int32_t>(nearest), difference_in_grains_[k].read(in_));
      code[k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(grains * grain));
    }
    learn_misses(code, by_map.code, like);
    return code;
  }
  for (std::size_t k = 0; k < layer_.numbers(); ++k) {
    if (is_lattice) {
      code[k] = sum_of(expected[k], difference.read(in_));
    } else {
      const std::uint32_t upper = in_.uniform(65'536), lower = in_.uniform(65'536);
      code[k] = static_cast<std::int32_t>(65'536 * upper + lower);
    }
  }
  if (is_lattice) learn_misses(code, by_map.code, like);
  return code;
}

void LayerReader::learn_misses(const Code& code, const Code& by_map, const Code& like) {
  const auto bits_of = [](std::int32_t off) {
    return std::uint32_t(std::bit_width(std::uint64_t(std::abs(std::int64_t(off)))));
  };
  for (std::uint32_t& miss : misses_) miss -= miss / 16;
  for (std::size_t k = 0; k < layer_.numbers(); ++k) {
    misses_[0] += bits_of(less(code[k], by_map[k]));
    misses_[1] += bits_of(less(code[k], like[k]));
  }
}

// "Expected by the map".
Expected LayerReader::expected_code(const std::vector<std::uint32_t>& corners) const {
  std::vector<Sample> samples;
  const auto vertex_at = [&](std::uint32_t corner) {
    return surface_.triangles[corner / 3][corner % 3];
  };
  const Point& v = surface_.places[vertex_at(corners[0])];
  const auto add = [&](std::uint32_t corner) {
    const std::uint32_t w = vertex_at(corner);
    if (is_known_[corner]) {
      samples.push_back({step(surface_.places[w], v), codes_[corner]});
    } else if (had_code(corner)) {
      samples.push_back({step(block_.coarse_place[block_.vertices[w].origin], v), codes_[corner]});
    }
  };
  for (const std::uint32_t corner : corners) {
    if (samples.empty()) add(corner);
  }
  FloatVector normal;
  for (const std::uint32_t corner : corners) {
    const std::uint32_t t = corner / 3, c = corner % 3;
    normal = normal + surface_.twice_area(t);
    add(3 * t + (c + 1) % 3);
    add(3 * t + (c + 2) % 3);
  }
  return expected_by_map(samples, normal, layer_.numbers());
}

}  // namespace

void read_layer(RangeDecoder& in, BlockState& block, const BlockLayer& layer,
                std::vector<Code>& codes) {
  LayerReader(in, block, layer, codes).read();
}

}  // namespace plain
