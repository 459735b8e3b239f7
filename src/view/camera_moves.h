// How the mouse and the keys move a camera. Everything is a function from one camera to the next.
//
//   camera = orbited(camera, dx_px, dy_px);
//   camera = zoomed(camera, 0.8, *focus);
#pragma once

#include "crease/camera.h"
#include "crease/vec.h"

namespace crease {

// Round its target by a drag of so many pixels: the model follows the mouse. Stops short of the
// poles.
Camera orbited(const Camera& camera, double right_px, double down_px);

// Moves so that what lies at the target's distance follows the mouse.
Camera panned(const Camera& camera, double right_px, double down_px);

// Towards `focus` until it is `factor` times as far away; what is under the mouse stays there if
// the focus is.
Camera zoomed(const Camera& camera, double factor, const Vec3d& focus);

// Turns the head: the target moves round the eye.
Camera turned(const Camera& camera, double right_px, double down_px);

// Moves eye and target, in the camera's frame: right, above, forward, model units.
Camera flown(const Camera& camera, const Vec3d& step);

// The same view round another point: the target becomes the foot of `point` on the line of sight.
Camera retargeted(const Camera& camera, const Vec3d& point);

struct Ray {
  Vec3d origin, direction;  // of any length
};
// Through a point of the picture, in pixels from its upper left.
Ray ray_through(const Camera& camera, double x_px, double y_px);

// Model units that a pixel covers at a distance along the line of sight.
double pixel_size(const Camera& camera, double distance);

}  // namespace crease
