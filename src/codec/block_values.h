// The values of attributes at the fine end of a block; included by block_coder.h.
#pragma once

#include "codec/block_coder.h"
#include "codec/deterministic_math.h"

#include <bit>
#include <cmath>

namespace crease::codec {

// The multiple of the grain that is nearest to a code, in grains; of two the greater.
inline std::int32_t nearest_grain(std::int32_t code, std::int32_t grain) {
  const std::int64_t raised = std::int64_t(code) + grain / 2;
  return static_cast<std::int32_t>(raised / grain - (raised % grain < 0));
}

// Goes round at 2^32, so that no bytes overflow it.
inline std::int32_t wrapped_product(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) * static_cast<std::uint32_t>(b));
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_layer(const BlockLayer& layer, std::vector<CodedValue>& values,
                                          std::size_t l) {
  LayerModels models(coding_.rates);
  if constexpr (Coder::kEncodes) {  // in one go, since the guide has them elsewhere
    wanted_.resize(values.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::uint32_t c = 0; c < 3; ++c) wanted_[3 * t + c] = guide_.value(l, t, c);
    }
  }
  is_known_.assign(values.size(), 0);
  for (std::uint32_t t = 0; t < coarse_triangles_; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      is_known_[3 * t + c] =
          !was_split(mesh_.triangles[t][c]) && !(layer.is_normal && was_derived_[t]);
    }
  }
  if (layer.octahedral_bits > 0) {
    start_directions(values, OctahedralCoding(layer.octahedral_bits));
  }
  for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) code_vertex(layer, values, models, v);
}

// Whether all corners at v are known.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::knows_corners(const BlockLayer& layer, std::uint32_t v) const {
  for (const std::uint32_t t : around_[v]) {
    if (!is_known_[3 * t + corner_of(mesh_.triangles[t], v)] &&
        !(layer.is_normal && mesh_.derived[t])) {
      return false;
    }
  }
  return true;
}

// The corners at one vertex. Mostly they share one value; else each is told to be like one that is
// known: beside it, at the coarse end, or at another corner of the triangle.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_vertex(const BlockLayer& layer, std::vector<CodedValue>& values,
                                           LayerModels& models, std::uint32_t v) {
  const auto shows = [&](std::uint32_t t) { return !(layer.is_normal && mesh_.derived[t]); };
  if (knows_corners(layer, v)) return;
  corners_.clear();
  const bool fan = look_around(v);
  CodedValue known{};
  std::size_t known_values = 0;  // distinct ones, up to two
  for (std::uint32_t t : fan ? ring_.triangles : around_[v]) {
    if (!shows(t)) continue;
    const std::uint32_t corner = 3 * t + std::uint32_t(corner_of(mesh_.triangles[t], v));
    corners_.push_back(corner);
    if (!is_known_[corner]) continue;
    if (known_values == 0) {
      known = values[corner];
      known_values = 1;
    } else if (values[corner] != known) {
      known_values = 2;
    }
  }
  if (fan && ring_.closed) {  // from the oldest triangle on, at which most is known
    std::rotate(corners_.begin(), std::min_element(corners_.begin(), corners_.end()),
                corners_.end());
  }
  const auto value_of = [&](std::uint32_t corner) {
    CodedValue value{};
    if constexpr (Coder::kEncodes) value = wanted_[corner];
    return value;
  };
  const auto had_value = [&](std::uint32_t corner) { return had_at_coarse_end(layer, corner); };

  if (known_values < 2) {
    bool uniform = true;
    if constexpr (Coder::kEncodes) {
      const CodedValue first = value_of(corners_[0]);
      for (std::uint32_t corner : corners_) uniform = uniform && value_of(corner) == first;
    }
    std::size_t bends = 0;
    for (std::size_t i = 1; i < std::min(corners_.size(), kLargestRing); ++i) {
      bends = std::max(bends, bend(corners_[i - 1] / 3, corners_[i] / 3));
    }
    if (coder_.bit(models.is_uniform[known_values][bends], uniform)) {
      CodedValue value = known;
      if (known_values == 0) value = code_shared_value(layer, values, models, v);
      for (std::uint32_t corner : corners_) {
        values[corner] = value;
        is_known_[corner] = 1;
      }
      if (layer.octahedral_bits > 0) normals_[v].stored = direction_of(layer, value);
      return;
    }
  }

  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::uint32_t corner = corners_[i], t = corner / 3;
    if (is_known_[corner]) continue;
    const CodedValue value = value_of(corner);
    tried_.clear();
    bool found = false;
    const auto try_value = [&](std::size_t kind, std::size_t bends, const CodedValue& candidate) {
      if (found || std::find(tried_.begin(), tried_.end(), candidate) != tried_.end()) return;
      if (coder_.bit(models.same_as[kind][tried_.size() > 0][bends], candidate == value)) {
        values[corner] = candidate;
        found = true;
      }
      tried_.push_back(candidate);
    };
    for (std::uint32_t c = 0; c < 3; ++c) {
      if (3 * t + c != corner && is_known_[3 * t + c]) try_value(0, 0, values[3 * t + c]);
    }
    const std::size_t last = corners_.size() - 1;
    const std::uint32_t previous = corners_[i > 0 ? i - 1 : last];
    const std::uint32_t next = corners_[i < last ? i + 1 : 0];
    for (const std::uint32_t beside : {previous, next}) {
      if (beside == corner || !is_known_[beside]) continue;
      try_value(1, bend(t, beside / 3), values[beside]);
    }
    if (had_value(corner)) try_value(2, 0, values[corner]);
    for (std::size_t k = 0; k < std::min(corners_.size(), kLargestRing) && !found; ++k) {
      if (tried_.size() >= kMostTried) break;
      if (!is_known_[corners_[k]]) continue;
      try_value(3, bend(t, corners_[k] / 3), values[corners_[k]]);
    }
    if (!found) {
      values[corner] =
          layer.octahedral_bits > 0
              ? code_corner_direction(layer, values, models, i, fan, value)
              : code_value(layer, models, value, tried_.empty() ? CodedValue{} : tried_.front(),
                           expected_value(layer, values, std::span(&corner, 1)));
    }
    is_known_[corner] = 1;
  }
}

template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::had_at_coarse_end(const BlockLayer& layer,
                                                 std::uint32_t corner) const {
  return !is_new(corner / 3) && !(layer.is_normal && was_derived_[corner / 3]);
}

template <class Coder, class Guide>
Spot BlockCoder<Coder, Guide>::direction_of(const BlockLayer& layer, const CodedValue& value) {
  const Vec3f d = OctahedralCoding(layer.octahedral_bits).decode(octahedral_code(value));
  return Spot{d.x, d.y, d.z, 0};
}

// One value for all corners_ of v, none of which is known. A vertex that stays mostly keeps the
// one that it had.
template <class Coder, class Guide>
CodedValue BlockCoder<Coder, Guide>::code_shared_value(const BlockLayer& layer,
                                                       const std::vector<CodedValue>& values,
                                                       LayerModels& models, std::uint32_t v) {
  CodedValue value{}, had{};
  if constexpr (Coder::kEncodes) value = wanted_[corners_[0]];
  bool has_had = false;
  for (const std::uint32_t corner : corners_) {
    if (!had_at_coarse_end(layer, corner)) continue;
    had = values[corner];
    has_had = true;
  }
  if (has_had && coder_.bit(models.is_kept[has_moved_[v]][v >= coarse_vertices_], value == had)) {
    return had;
  }
  if (layer.octahedral_bits == 0) {
    return code_value(layer, models, value, had, expected_value(layer, values, corners_));
  }
  Sizes sizes;
  const DirectionCandidates candidates =
      direction_candidates(v, has_had ? direction_of(layer, had) : Spot{}, sizes);
  const OctahedralCoding coding(layer.octahedral_bits);
  DirectionMixture mixture = models.direction.mixture(coding, candidates, sizes);
  const CodedValue result = coded(code_direction(coder_, coding, mixture, octahedral_code(value)));
  models.direction.learn(mixture, sizes);
  return result;
}

// Of corners_[i], which none of the others is like: mostly its triangle's normal, or that of the
// triangles which go on from there without an edge. `fan`: corners_ are in the order of ring_.
template <class Coder, class Guide>
CodedValue BlockCoder<Coder, Guide>::code_corner_direction(const BlockLayer& layer,
                                                           const std::vector<CodedValue>& values,
                                                           LayerModels& models, std::size_t i,
                                                           bool fan, const CodedValue& value) {
  const std::uint32_t corner = corners_[i], t = corner / 3;
  const Spot own = areas_[t].twice;
  Spot smooth = own, bent = own;
  const std::size_t count = corners_.size();
  for (const bool back : {false, true}) {
    if (!fan) break;
    bool is_smooth = true;
    std::uint32_t last = t;
    for (std::size_t k = 1; k < std::min(count, kFarthestBeside); ++k) {
      if (!ring_.closed && (back ? k > i : i + k >= count)) break;
      const std::uint32_t next = corners_[back ? (i + count - k) % count : (i + k) % count] / 3;
      const std::size_t turned = bend(last, next);
      is_smooth = is_smooth && turned < 2;
      if (turned > 2) break;
      if (is_smooth) smooth += areas_[next].twice;
      bent += areas_[next].twice;
      last = next;
    }
  }
  DirectionCandidates candidates;
  Spot beside{};
  for (std::uint32_t c = 0; c < 3; ++c) {
    if (3 * t + c != corner && is_known_[3 * t + c])
      beside += direction_of(layer, values[3 * t + c]);
  }
  const Spot had = had_at_coarse_end(layer, corner) ? direction_of(layer, values[corner]) : Spot{};
  const Spot first = tried_.empty() ? Spot{} : direction_of(layer, tried_.front());
  const Spot one = areas_[t].unit;
  beside = normalized(beside);
  smooth = normalized(smooth);
  candidates.of = {one,
                   smooth,
                   had,
                   normalized(bent),
                   first,
                   beside,
                   normals_[mesh_.triangles[t][corner % 3]].geometric,
                   one};
  const Sizes sizes = std::bit_cast<Sizes>(rough_log2_of_each(
      FourFloats{length(smooth - one), length(had - one), length(own), length(beside - one)} +
      FourFloats{0.002f, 0.002f, 1, 0.002f}));
  const OctahedralCoding coding(layer.octahedral_bits);
  DirectionMixture mixture = models.corner_direction.mixture(coding, candidates, sizes);
  const CodedValue result = coded(code_direction(coder_, coding, mixture, octahedral_code(value)));
  models.corner_direction.learn(mixture, sizes);
  return result;
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::keep_coarse_positions() {
  for (const BlockLayer& layer : coding_.layers) {
    if (layer.is_lattice()) coarse_positions_ = mesh_.positions;
  }
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::keep_coarse_normals() {
  bool any = false;
  for (const BlockLayer& layer : coding_.layers) any = any || layer.octahedral_bits > 0;
  if (!any) return;
  coarse_normals_.assign(coarse_vertices_, Spot{});
  for (std::uint32_t t = 0; t < coarse_triangles_; ++t) {
    const Spot twice = twice_area(t);
    for (const std::uint32_t v : mesh_.triangles[t]) coarse_normals_[v] += twice;
  }
  for (Spot& n : coarse_normals_) n = normalized(n);
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::start_directions(const std::vector<CodedValue>& values,
                                                const OctahedralCoding& coding) {
  const std::size_t vertices = mesh_.positions.size();
  normals_.assign(vertices, Normals{});
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh_.triangles[t][c];
      normals_[v].geometric += areas_[t].twice;
      if (!is_known_[3 * t + c] || !is_zero(normals_[v].stored)) continue;
      const Vec3f d = coding.decode(octahedral_code(values[3 * t + c]));
      normals_[v].stored = Spot{d.x, d.y, d.z, 0};
    }
  }
  for (Normals& n : normals_) n.geometric = normalized(n.geometric);
}

template <class Coder, class Guide>
DirectionCandidates BlockCoder<Coder, Guide>::direction_candidates(std::uint32_t v, const Spot& had,
                                                                   Sizes& sizes) const {
  const Spot geometric = normals_[v].geometric;
  Spot even{}, angles{}, off{}, beside{};
  FourFloats spread{};  // by component
  std::int32_t known = 0;
  const Vec3i q = mesh_.positions[v];
  const std::span<const std::uint32_t> list =
      around_[v].first(std::min(around_[v].size(), kLargestRing));
  std::uint32_t last = kNone;  // mostly the next triangle begins there
  Spot at_last{};
  for (std::size_t first = 0; first < list.size(); first += 4) {
    std::array<Spot, 4> after_v{}, before_v{};  // of four triangles
    const std::size_t count = std::min<std::size_t>(list.size() - first, 4);
    for (std::size_t i = 0; i < count; ++i) {
      const Corners& corners = mesh_.triangles[list[first + i]];
      const std::size_t c = corner_of(corners, v);
      const std::uint32_t after = corners[kCornerAfter[c]], before = corners[kCornerBefore[c]];
      after_v[i] = after == last ? at_last : seen_from(q, mesh_.positions[after]);
      before_v[i] = at_last = seen_from(q, mesh_.positions[before]);
      last = before;
      const Normals& of = normals_[after];
      spread += of.geometric * geometric;
      // Adds nothing where it is zero.
      const std::int32_t is_one = -static_cast<std::int32_t>(!is_zero(of.stored));
      off += std::bit_cast<Spot>(std::bit_cast<FourInts>(of.stored - of.geometric) & is_one);
      beside += of.stored;
      known -= is_one;
    }
    const auto [ax, ay, az] = coordinates_of(after_v[0], after_v[1], after_v[2], after_v[3]);
    const auto [bx, by, bz] = coordinates_of(before_v[0], before_v[1], before_v[2], before_v[3]);
    const FourFloats x = ay * bz - az * by, y = az * bx - ax * bz, z = ax * by - ay * bx;
    const FourFloats sine = root(x * x + y * y + z * z);  // times lengths
    const FourFloats cosine = ax * bx + ay * by + az * bz;
    const FourFloats squares = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz);
    const FourInts has_area = sine > FourFloats{};
    const auto weighed = [&](const FourFloats& coordinate, const FourFloats& weight) {
      return std::bit_cast<FourFloats>(std::bit_cast<FourInts>(coordinate * weight) & has_area);
    };
    const FourFloats by_size = 1.0f / root(squares), by_area = rough_angle(sine, cosine) / sine;
    for (const Spot& n : spots_at(weighed(x, by_size), weighed(y, by_size), weighed(z, by_size))) {
      even += n;
    }
    for (const Spot& n : spots_at(weighed(x, by_area), weighed(y, by_area), weighed(z, by_area))) {
      angles += n;
    }
  }
  DirectionCandidates result;
  const Spot mean_off = known > 0 ? off * (1 / static_cast<float>(known)) : Spot{};
  const std::uint32_t origin = origin_[v];
  const bool has_had = !is_zero(had);
  result.of = {geometric,
               normalized(even),
               had,
               has_had && origin < coarse_normals_.size()
                   ? geometric + had - coarse_normals_[origin]
                   : Spot{},
               known > 0 ? geometric + mean_off : Spot{},
               normalized(beside),
               normalized(angles),
               has_had ? had + geometric : Spot{}};
  const float mean_spread =
      list.empty() ? 1 : sum_of_three(spread) / static_cast<float>(list.size());
  const FourFloats logarithms =
      rough_log2_of_each(FourFloats{length(mean_off), std::sqrt(std::max(0.0f, 1 - mean_spread)),
                                    length(had - geometric), 0} +
                         0.002f);
  sizes = {logarithms[0], logarithms[1], logarithms[2], known > 0 ? 1.0f : 0.0f};
  return result;
}

// Of corners at one vertex that share a value: from what they had at the coarse end, and from what
// the others of their triangles have, or had there.
template <class Coder, class Guide>
ValuePrediction BlockCoder<Coder, Guide>::expected_value(const BlockLayer& layer,
                                                         const std::vector<CodedValue>& values,
                                                         std::span<const std::uint32_t> corners) {
  if (!layer.is_lattice()) return {};
  samples_.clear();
  const Vec3i q = mesh_.positions[mesh_.triangles[corners[0] / 3][corners[0] % 3]];
  const auto add = [&](std::uint32_t corner) {
    const std::uint32_t w = mesh_.triangles[corner / 3][corner % 3];
    if (is_known_[corner]) {
      samples_.push_back({seen_from(q, mesh_.positions[w]), values[corner]});
    } else if (had_at_coarse_end(layer, corner)) {  // so w comes from a vertex there
      samples_.push_back({seen_from(q, coarse_positions_[origin_[w]]), values[corner]});
    }
  };
  for (const std::uint32_t corner : corners) {
    if (!samples_.empty()) break;
    add(corner);
  }
  Spot normal{};
  for (const std::uint32_t corner : corners) {
    const std::uint32_t t = corner / 3, c = corner % 3;
    normal += areas_[t].twice;
    add(3 * t + std::uint32_t(kCornerAfter[c]));
    add(3 * t + std::uint32_t(kCornerBefore[c]));
  }
  return predict_value(samples_, normal, std::size_t(layer.dimension));
}

template <class Coder, class Guide>
CodedValue BlockCoder<Coder, Guide>::code_value(const BlockLayer& layer, LayerModels& models,
                                                const CodedValue& value, const CodedValue& like,
                                                const ValuePrediction& by_map) {
  const bool is_by_map = models.misses[0] <= models.misses[1];
  const CodedValue& predicted = is_by_map ? by_map.value : like;
  SignedModel& residual = models.residual[is_by_map ? by_map.doubt : kDoubts];
  CodedValue result{};
  const std::size_t dimension = std::size_t(layer.dimension);
  const auto is_of_grain = [&](const CodedValue& code) {
    for (std::size_t k = 0; k < dimension; ++k) {
      if (code[k] % layer.grains[k] != 0) return false;
    }
    return true;
  };
  if (layer.has_grain() &&
      coder_.bit(models.is_of_grain[is_of_grain(predicted)], is_of_grain(value))) {
    for (std::size_t k = 0; k < dimension; ++k) {
      const std::int32_t grain = layer.grains[k], expected = nearest_grain(predicted[k], grain);
      const std::int32_t step = wrapped_difference(value[k] / grain, expected);
      result[k] = wrapped_product(
          wrapped_sum(expected, code_signed(coder_, models.residual_in_grains[k], step)), grain);
    }
    models.learn_misses(result, by_map.value, like, dimension);
    return result;
  }
  for (std::size_t k = 0; k < dimension; ++k) {
    if (layer.is_raw) {
      const std::uint32_t bits = static_cast<std::uint32_t>(value[k]);
      const std::uint32_t high = coder_.uniform(1u << 16, bits >> 16);
      const std::uint32_t low = coder_.uniform(1u << 16, bits & 0xffff);
      result[k] = static_cast<std::int32_t>(high << 16 | low);
    } else {
      result[k] = wrapped_sum(
          predicted[k], code_signed(coder_, residual, wrapped_difference(value[k], predicted[k])));
    }
  }
  models.learn_misses(result, by_map.value, like, dimension);
  return result;
}

}  // namespace crease::codec
