// Four triangles of a pair's ring side by side, and what becomes of them when the end of the pair
// that they have moves.
#pragma once

#include "hierarchy/quadric.h"
#include "simplify/flat_shading.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crease::simplification {

using Lanes = decltype(Row{} < Row{});  // of each triangle: all bits, or none

inline void take_root(const Row& square, Row& root) {
  root =
      Row{std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]), std::sqrt(square[3])};
}

// FlatShading of four triangles, where some of them need it.
struct ShadingBlock {
  Row input_sum[3], input_area, stored[3], stored_error, stored_counts, counts;
  Lanes derived;

  // FlatShading::counts_with(), less what they count.
  void more_with(const Row* normal, const Row& area, Row& more) const {
    const Row none{};
    Row geometric = 2 * (input_area - (input_sum[0] * normal[0] + input_sum[1] * normal[1] +
                                       input_sum[2] * normal[2]));
    geometric = geometric > 0 ? geometric : none;
    const Lanes by_geometry = derived | (geometric + kDeriveMargin * input_area < stored_error);
    const Row turn[] = {normal[0] - stored[0], normal[1] - stored[1], normal[2] - stored[2]};
    const Row turn2 = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    const Row chord2 = by_geometry ? geometric / input_area : turn2;
    Row chord;
    take_root(chord2, chord);
    const Row linear = kLinearChord / (chord + kRoundingChord);
    const Row one = none + 1;
    const Row weighed = chord2 * (linear > 1 ? linear : one);
    const Row least_area = input_area < area ? input_area : area;
    const Row turned = turn2 > 2 ? area : least_area;
    const Row by_stored = stored_counts + turned * weighed;
    const Row by_input = geometric > 0 ? input_area * weighed : none;
    more = (by_geometry ? by_input : by_stored) - counts;
    more = more > 0 ? more : none;
  }
};

struct RingBlock {
  static constexpr std::size_t kTriangles = 4;

  // As they are: the two vertices that stay, unit normal (or zero), area.
  Row next[3], previous[3], normal[3];
  Row area;
  Lanes shows;             // is flat or derived
  Lanes right;             // and shows what it stands for
  std::uint32_t ring = 0;  // whose triangles these are: the pairs' rings are counted
  bool has_shading = false;
  ShadingBlock shading;

  struct Moved {
    Row normal[3];  // twice the area long
    Row length2;
    Row agreement;  // with the normal before, times the length
  };
  Moved moved_to(const Vec3d& target) const {
    Row u[3], v[3];
    for (int i = 0; i < 3; ++i) {
      u[i] = next[i] - target[i];
      v[i] = previous[i] - target[i];
    }
    Moved m;
    m.normal[0] = u[1] * v[2] - u[2] * v[1];
    m.normal[1] = u[2] * v[0] - u[0] * v[2];
    m.normal[2] = u[0] * v[1] - u[1] * v[0];
    const Row* n = m.normal;
    m.length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    m.agreement = normal[0] * n[0] + normal[1] * n[1] + normal[2] * n[2];
    return m;
  }
};

// The lanes as bits, the first triangle's the lowest.
inline unsigned bits_of(const Lanes& lanes) {
  const Lanes bits = lanes & Lanes{1, 2, 4, 8};
  return static_cast<unsigned>((bits[0] | bits[2]) | (bits[1] | bits[3]));
}

}  // namespace crease::simplification
