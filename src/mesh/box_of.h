// The box around points.
#pragma once

#include "crease/mesh.h"

#include <algorithm>
#include <limits>
#include <span>

namespace crease {

struct PointBox {
  Vec3d low, size;
  double longest = 0;
};

inline PointBox box_of(std::span<const Vec3d> positions) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  if (positions.empty()) return {};
  Vec3d low{kInf, kInf, kInf}, high{-kInf, -kInf, -kInf};
  for (const Vec3d& p : positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  const Vec3d size = high - low;
  return {low, size, std::max({size.x, size.y, size.z})};
}

}  // namespace crease
