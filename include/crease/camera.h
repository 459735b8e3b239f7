// From where something is seen.
#pragma once

#include "crease/vec.h"

namespace crease {

// DESIGN 9: {"position":[x,y,z],"target":[x,y,z],"up":[x,y,z],"vertical_fov":45,
//            "viewport":[1920,1080],"pixels":1}
// Parallel projection of `h` model units of height is a vertical_fov_deg of 0.01 from 5730 h away.
struct Camera {
  Vec3d position{0, 0, 1}, target, up{0, 0, 1};
  double vertical_fov_deg = 45;
  int width_px = 1920, height_px = 1080;
  double pixels = 1;  // error allowed on screen

  bool operator==(const Camera&) const = default;
};

}  // namespace crease
