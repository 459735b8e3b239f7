// The point of a triangle that is closest to a given one, in doubles.
#pragma once

#include "crease/vec.h"

#include <array>

namespace crease {

struct ClosestPoint {
  double squared_distance = 0;
  std::array<double, 3> weights{};  // barycentric: the point is the weighted sum of the corners
};

// Any triangle will do, those without area too. The error of the distance is about 1e-16 of the
// triangle's length times its aspect ratio.
ClosestPoint closest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace crease
