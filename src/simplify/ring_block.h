// Four triangles of a pair's ring side by side, and what becomes of them when the end of the pair
// that they have moves.
#pragma once

#include "hierarchy/quadric.h"

#include <cstddef>
#include <cstdint>

namespace crease::simplification {

using Lanes = decltype(Row{} < Row{});  // of each triangle: all bits, or none

struct RingBlock {
  static constexpr std::size_t kTriangles = 4;

  // As they are: the two vertices that stay, unit normal (or zero), area.
  Row next[3], previous[3], normal[3];
  Row area;
  Lanes shows;             // is flat or derived
  Lanes right;             // and shows what it stands for
  std::uint32_t ring = 0;  // whose triangles these are: the pairs' rings are counted

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
