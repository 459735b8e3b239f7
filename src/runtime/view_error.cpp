#include "runtime/view_error.h"

namespace crease {

namespace {

Vec3f as_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

ViewError::ViewError(const ViewParameters& view, const Grid& grid)
    : eye_(as_float(view.camera.position - grid.origin)),
      step_(grid.step),
      per_pixel_(static_cast<float>(1 / std::max(view.camera.pixels, 1e-12))),
      per_degree_(view.degrees > 0 ? static_cast<float>(1 / view.degrees) : 0.0f),
      silhouette_weight_(static_cast<float>(view.silhouette_weight)),
      coarse_outside_(view.coarse_outside),
      coarse_backfaces_(view.coarse_backfaces),
      uses_cones_(view.coarse_backfaces || view.silhouette_weight != 1) {
  const Camera& camera = view.camera;
  const double half = std::tan(radians(camera.vertical_fov_deg) / 2);
  const double wide = half * camera.width_px / camera.height_px;
  pixels_per_radian_ = static_cast<float>(camera.height_px / (2 * half));
  const Vec3d forward = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(forward, camera.up));
  const Vec3d up = cross(right, forward);
  planes_ = {as_float(forward), as_float(normalized(forward * wide + right)),
             as_float(normalized(forward * wide - right)),
             as_float(normalized(forward * half + up)), as_float(normalized(forward * half - up))};
}

float ViewError::weight_of_facing(const SplitBounds& bounds, const Vec3f& to, float distance,
                                  float radius) const {
  const float sine_of_sphere = radius / distance;
  if (bounds.cone_angle >= 128 || !(sine_of_sphere < 1)) return silhouette_weight_;
  // All directions from the eye to the sphere and all normals differ from the axes by this much.
  const NormalCone cone = bounds.cone();
  const float spread = cone.half_angle_rad + std::asin(std::max(sine_of_sphere, -1.0f));
  if (spread >= static_cast<float>(kPi) / 2) return silhouette_weight_;
  const float sine = std::sin(spread);
  const float facing = dot(cone.axis, to) / distance;
  if (facing > sine) return coarse_backfaces_ ? 0.0f : 1.0f;
  return facing < -sine ? 1.0f : silhouette_weight_;
}

}  // namespace crease
