// Cones of directions that grow: the smallest cone around two cones, in doubles.
#pragma once

#include "crease/mesh_hierarchy.h"
#include "crease/vec.h"

#include <algorithm>
#include <cmath>

namespace crease {

struct GrowingCone {
  Vec3d axis;
  double half_angle = -1;  // none yet; pi: everything

  static GrowingCone of(const Vec3d& direction) {  // none for the zero vector
    const Vec3d n = normalized(direction);
    return n == Vec3d{} ? GrowingCone{} : GrowingCone{n, 0};
  }
  bool is_empty() const { return half_angle < 0; }

  void add(const GrowingCone& o) {
    if (o.is_empty()) return;
    if (is_empty()) {
      *this = o;
      return;
    }
    const double between = angle_between(axis, o.axis);
    if (between + o.half_angle <= half_angle) return;
    if (between + half_angle <= o.half_angle) {
      *this = o;
      return;
    }
    const double grown = (between + half_angle + o.half_angle) / 2;
    if (grown >= kPi) {
      half_angle = kPi;
      return;
    }
    // The axis turns towards the other one by what the cone grows.
    // Nearly opposite axes leave no direction to turn to but rounding errors.
    const Vec3d rest = o.axis - axis * dot(axis, o.axis);
    if (between > 3 && length(rest) < 1e-6) {
      half_angle = kPi;
      return;
    }
    const Vec3d across = normalized(rest);
    const double turn = grown - half_angle;
    axis = normalized(axis * std::cos(turn) + across * std::sin(turn));
    half_angle = grown + 1e-9;
  }

  static double angle_between(const Vec3d& a, const Vec3d& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
  }
};

}  // namespace crease
