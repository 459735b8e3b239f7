// The axes of a camera's picture. Cuts and pictures have the same ones, or a cut would be fine
// where the picture is not.
#pragma once

#include "crease/camera.h"
#include "crease/vec.h"

#include <cmath>

namespace crease {

struct ViewFrame {
  Vec3d forward, right, up;  // of unit length, at right angles
};

// Where the camera looks along its `up`, but for rounding, another axis is taken for that.
inline ViewFrame view_frame(const Camera& camera) {
  constexpr double kParallel = 1e-6;
  ViewFrame frame;
  frame.forward = normalized(camera.target - camera.position);
  if (frame.forward == Vec3d{}) frame.forward = {0, 0, -1};
  frame.right = cross(frame.forward, normalized(camera.up));
  if (!(length(frame.right) >= kParallel)) {
    const Vec3d other = std::abs(frame.forward.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    frame.right = cross(frame.forward, other);
  }
  frame.right = normalized(frame.right);
  frame.up = cross(frame.right, frame.forward);
  return frame;
}

}  // namespace crease
