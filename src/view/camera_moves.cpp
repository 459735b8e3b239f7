#include "view/camera_moves.h"

#include "render/transform.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr double kDegreesPerPixel = 0.35;
constexpr double kLeastDistance = 1e-9;  // of the target, beside how far both are from the origin
constexpr double kNearestPoleDeg = 0.5;

View view_of(const Camera& camera) {
  return make_view(camera, double(camera.width_px) / camera.height_px);
}

Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle) {
  return v * std::cos(angle) + cross(axis, v) * std::sin(angle) +
         axis * (dot(axis, v) * (1 - std::cos(angle)));
}

// An arm turned round `up` and towards or away from it.
Vec3d swung(const Vec3d& arm, const Camera& camera, double round_rad, double from_pole_rad) {
  Vec3d up = normalized(camera.up);
  if (up == Vec3d{}) up = {0, 0, 1};
  const double reach = length(arm);
  const double pole = std::acos(std::clamp(dot(arm, up) / reach, -1.0, 1.0));
  const double nearest = radians(kNearestPoleDeg);
  const double wanted = std::clamp(pole + from_pole_rad, nearest, kPi - nearest);
  // Level direction of the arm; at a pole the one that the picture's right side tells.
  Vec3d level = arm - up * dot(arm, up);
  if (length(level) < 1e-9 * reach) level = cross(view_of(camera).right, up);
  level = rotated(normalized(level), up, round_rad);
  return (level * std::sin(wanted) + up * std::cos(wanted)) * reach;
}

}  // namespace

Camera orbited(const Camera& camera, double right_px, double down_px) {
  Camera moved = camera;
  const double step = radians(kDegreesPerPixel);
  moved.position = camera.target + swung(camera.position - camera.target, camera, -step * right_px,
                                         -step * down_px);
  return moved;
}

Camera turned(const Camera& camera, double right_px, double down_px) {
  Camera moved = camera;
  const double step = radians(kDegreesPerPixel) / 2;
  moved.target = camera.position +
                 swung(camera.target - camera.position, camera, -step * right_px, step * down_px);
  return moved;
}

Camera panned(const Camera& camera, double right_px, double down_px) {
  const View view = view_of(camera);
  const double size = pixel_size(camera, length(camera.target - camera.position));
  const Vec3d step = view.right * (-right_px * size) + view.above * (down_px * size);
  Camera moved = camera;
  moved.position += step;
  moved.target += step;
  return moved;
}

Camera zoomed(const Camera& camera, double factor, const Vec3d& focus) {
  // Nearer, no step could be told from none any more.
  const double least = kLeastDistance * std::max(length(camera.position), length(camera.target));
  if (factor < 1 && factor * length(camera.target - camera.position) < least) return camera;
  Camera moved = camera;
  moved.position = focus + (camera.position - focus) * factor;
  moved.target = focus + (camera.target - focus) * factor;
  return moved;
}

Camera flown(const Camera& camera, const Vec3d& step) {
  const View view = view_of(camera);
  const Vec3d move = view.right * step.x + view.above * step.y - view.back * step.z;
  Camera moved = camera;
  moved.position += move;
  moved.target += move;
  return moved;
}

Camera retargeted(const Camera& camera, const Vec3d& point) {
  const View view = view_of(camera);
  const double depth = -dot(point - camera.position, view.back);
  if (!(depth > 0)) return camera;
  Camera moved = camera;
  moved.target = camera.position - view.back * depth;
  return moved;
}

Ray ray_through(const Camera& camera, double x_px, double y_px) {
  const View view = view_of(camera);
  const double x = (2 * x_px / camera.width_px - 1) * view.tan_half_width;
  const double y = (1 - 2 * y_px / camera.height_px) * view.tan_half_height;
  return {camera.position, view.right * x + view.above * y - view.back};
}

double pixel_size(const Camera& camera, double distance) {
  return 2 * distance * std::tan(radians(camera.vertical_fov_deg) / 2) / camera.height_px;
}

}  // namespace crease
