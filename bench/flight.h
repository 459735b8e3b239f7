// The paths that cameras fly along.
#pragma once

#include "crease/camera.h"
#include "crease/vec.h"

#include <span>

namespace crease::bench {

struct Box {
  Vec3d low, high;
  Vec3d at(double x, double y, double z) const {
    return {low.x + x * (high.x - low.x), low.y + y * (high.y - low.y),
            low.z + z * (high.z - low.z)};
  }
  double diagonal() const { return length(high - low); }
};

// There must be some.
Box box_of(std::span<const Vec3d> positions);

// A city is flown over, low, along a curve that looks ahead; anything else is orbited, near and
// far. `share`: of the whole path, which ends where it begins.
Camera camera_at(const Box& box, bool is_city, double share);

}  // namespace crease::bench
