// From where something is seen.
#pragma once

#include "crease/vec.h"

#include <cmath>

namespace crease {

// As JSON: {"position":[x,y,z],"target":[x,y,z],"up":[x,y,z],"vertical_fov":45,
//           "viewport":[1920,1080],"pixels":1}
// Parallel projection of `h` model units of height is a vertical_fov_deg of 0.01 from 5730 h away.
struct Camera {
  Vec3d position{0, 0, 1}, target, up{0, 0, 1};
  double vertical_fov_deg = 45;
  int width_px = 1920, height_px = 1080;
  double pixels = 1;  // error allowed on screen

  bool operator==(const Camera&) const = default;
};

// Whether it is finite, looks from one place to another, with an angle of view between 0 and 180
// degrees, at a picture that has pixels. A mesh that is told to show what another one sees, of a
// minimised window for instance, goes on showing what it did.
inline bool can_see(const Camera& c) {
  const Vec3d all = c.position + c.target + c.up;
  return std::isfinite(all.x + all.y + all.z + c.pixels) && c.position != c.target &&
         c.up != Vec3d{} && c.vertical_fov_deg > 0 && c.vertical_fov_deg < 180 && c.width_px > 0 &&
         c.height_px > 0;
}

}  // namespace crease
