// What a camera sees, as lines, and a camera that looks at it from outside.
#pragma once

#include "render/fit_camera.h"

#include <vector>

namespace crease {

struct Segment {
  Vec3d from, to;
};

// The four edges of the frustum to a rectangle behind all that the camera sees of the scene, and
// the picture itself near the eye, with a mark above it. Where nothing is seen it is as long as the
// scene. Over a flat scene the frustum is cut off at the scene's sides, top and bottom.
std::vector<Segment> frustum_lines(Scene scene, const Camera& camera);

// From beside, behind and above `seen`, as close as shows the whole scene, its eye and its picture.
// Lines that go far beyond the scene may leave the picture.
Camera fit_outside(Scene scene, const Camera& seen, int width_px, int height_px);

}  // namespace crease
