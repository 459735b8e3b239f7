#include "plain_decoder/directions.h"

namespace plain {

namespace {

float size(float x) {
  return log2_of(x);
}

}  // namespace

DirectionModel::DirectionModel(const DirectionStart& start, const Rates& rates) {
  weights_.of = start.weights;
  scales_ = {start.logarithms, start.slopes, rates.direction_slopes, rates.first};
  mean_.rate = rates.mean;
}

Code DirectionModel::read(RangeDecoder& in, const Octahedral& coding, const Candidates& candidates,
                          const Sizes& sizes) {
  const Octahedral::Frame frame = coding.frame(coding.rough(candidates[0]));
  const PerComponent scale = scales_.at(sizes);
  Axis axis;
  axis.weight = weights_.of;
  PerComponent second_centre{}, excesses{};
  for (std::size_t k = 0; k < kComponents; ++k) {
    axis.inverse_scale[k] = 1 / (scale[k] + 0.1f);
    if (candidates[k].is_zero()) {
      axis.weight[k] = 0;
      continue;
    }
    const std::array<float, 2> near = coding.near(candidates[k], frame);
    axis.centre[k] = near[0];
    second_centre[k] = near[1];
  }
  // 1.
  const std::int32_t x = read_axis(in, axis, 0, scale[0]);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float i = axis.inverse_scale[k], z = (float(x) - axis.centre[k]) * i;
    excesses[k] = excess(z * z) * (1 - 0.1f * i);
    axis.inverse_scale[k] = 1 / (scale[k] * std::sqrt(0.5f + 0.5f * z * z) + 0.1f);
  }
  // 2.
  axis.centre = second_centre;
  const std::int32_t y = read_axis(in, axis, 0, scale[0]);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float i = axis.inverse_scale[k], z = (float(y) - axis.centre[k]) * i;
    excesses[k] += excess(z * z) * (1 - 0.1f * i);
  }
  PerComponent shares = axis.weight;
  if (make_shares(shares)) {
    weights_.learn(shares);
    mean_.learn(sizes);
    scales_.learn(shares, excesses, sizes, mean_.of);
  }
  return coding.restore(x, y, frame);
}

std::vector<FloatVector> normals_of_vertices(const Surface& surface) {
  std::vector<FloatVector> normals(surface.places.size());
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const FloatVector twice = surface.twice_area(t);
    for (const std::uint32_t v : surface.triangles[t]) normals[v] = normals[v] + twice;
  }
  for (FloatVector& normal : normals) normal = unit(normal);
  return normals;
}

DirectionReader::DirectionReader(RangeDecoder& in, const BlockState& block, int bits,
                                 const std::vector<Code>& codes, const std::vector<bool>& is_known)
    : in_(in),
      block_(block),
      surface_(block.surface),
      coding_(bits),
      codes_(codes),
      is_known_(is_known),
      geometric_(normals_of_vertices(block.surface)),
      stored_(block.surface.places.size()) {
  for (std::uint32_t corner = 0; corner < codes.size(); ++corner) {
    const std::uint32_t v = surface_.triangles[corner / 3][corner % 3];
    if (is_known[corner] && stored_[v].is_zero()) store(v, codes[corner]);
  }
}

// "Direction of a whole vertex".
Code DirectionReader::read_of_vertex(std::uint32_t v, const std::optional<Code>& had) {
  const FloatVector& g = geometric_[v];
  FloatVector E, F, off, beside, spread;
  float triangles = 0, count = 0;
  for (const std::uint32_t t : surface_.first_of_list(v)) {
    const std::uint32_t a = surface_.start_of(t, v), b = surface_.end_of(t, v);
    const FloatVector p = step(surface_.places[a], surface_.places[v]);
    const FloatVector q = step(surface_.places[b], surface_.places[v]);
    const FloatVector n = cross(p, q);
    const float area = length(n);
    if (area > 0) {
      E = E + n * (1 / std::sqrt(dot(p, p) * dot(q, q)));
      F = F + n * (angle_of(area, dot(p, q)) / area);
    }
    triangles += 1;
    spread =
        spread + FloatVector{geometric_[a].x * g.x, geometric_[a].y * g.y, geometric_[a].z * g.z};
    if (stored_[a].is_zero()) continue;
    off = off + (stored_[a] - geometric_[a]);
    beside = beside + stored_[a];
    count += 1;
  }
  const FloatVector h = direction(had);
  const FloatVector o = count > 0 ? off * (1 / count) : FloatVector{};
  const std::uint32_t origin = block_.vertices[v].origin;
  Candidates candidates{};
  candidates[0] = g;
  candidates[1] = unit(E);
  candidates[2] = h;
  if (!h.is_zero() && origin < block_.coarse_vertices) {
    candidates[3] = g + h - block_.coarse_normal[origin];
  }
  if (count > 0) candidates[4] = g + o;
  candidates[5] = unit(beside);
  candidates[6] = unit(F);
  if (!h.is_zero()) candidates[7] = h + g;
  const float mean_spread = triangles > 0 ? (spread.x + spread.y + spread.z) / triangles : 1;
  const Sizes sizes{size(length(o) + 0.002f),
                    size(std::sqrt(std::max(0.0f, 1 - mean_spread)) + 0.002f),
                    size(length(h - g) + 0.002f), count > 0 ? 1.0f : 0.0f};
  return of_vertex_.read(in_, coding_, candidates, sizes);
}

void DirectionReader::add_onwards(const CornerDirection& asked, bool backwards, FloatVector& S,
                                  FloatVector& B) const {
  const std::size_t n = asked.corners.size(), c = asked.at;
  std::uint32_t before = asked.corners[c] / 3;
  bool all_flat = true;
  for (std::size_t k = 1; k <= 16 && k < n; ++k) {
    if (!asked.is_closed && (backwards ? k > c : c + k >= n)) return;
    const std::uint32_t t = asked.corners[backwards ? (c + n - k) % n : (c + k) % n] / 3;
    const std::size_t bend = surface_.bend(before, t);
    if (bend == 3) return;
    if (bend > 1) all_flat = false;
    const FloatVector twice = surface_.twice_area(t);
    if (all_flat) S = S + twice;
    B = B + twice;
    before = t;
  }
}

// "Direction of one corner".
Code DirectionReader::read_of_corner(const CornerDirection& asked) {
  const std::uint32_t corner = asked.corners[asked.at], t = corner / 3;
  const FloatVector own = surface_.twice_area(t);
  FloatVector S = own, B = own;
  if (asked.is_fan) {
    add_onwards(asked, false, S, B);
    add_onwards(asked, true, S, B);
  }
  FloatVector beside;
  for (std::uint32_t other = 3 * t; other < 3 * t + 3; ++other) {
    if (other != corner && is_known_[other]) beside = beside + coding_.direction(codes_[other]);
  }
  const Candidates candidates{unit(own),
                              unit(S),
                              direction(asked.had),
                              unit(B),
                              direction(asked.tried),
                              unit(beside),
                              geometric_[asked.vertex],
                              unit(own)};
  const auto from_own = [&](std::size_t k) {
    return size(length(candidates[k] - candidates[0]) + 0.002f);
  };
  const Sizes sizes{from_own(1), from_own(2), size(length(own) + 1), from_own(5)};
  return of_corner_.read(in_, coding_, candidates, sizes);
}

}  // namespace plain
