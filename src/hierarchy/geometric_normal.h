// The normal that a derived triangle shows: that of its corners on the grid.
//
// Differences of grid positions fit 33 bits, so doubles round the products; every place that shows
// a derived normal calls this function with the corners in the triangle's own order and therefore
// gets the same bits.
#pragma once

#include "crease/vec.h"

#include <cstdint>

namespace crease {

// The zero vector for a triangle without area.
inline Vec3f geometric_normal(const Vec3i& a, const Vec3i& b, const Vec3i& c) {
  const auto edge = [&a](const Vec3i& to) -> Vec3d {
    return {double(std::int64_t(to.x) - a.x), double(std::int64_t(to.y) - a.y),
            double(std::int64_t(to.z) - a.z)};
  };
  const Vec3d n = normalized(cross(edge(b), edge(c)));
  return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
}

}  // namespace crease
