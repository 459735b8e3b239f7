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
      per_degree_(view.degrees > 0 ? static_cast<float>(1 / view.degrees) : 0.0f),
      silhouette_weight_(static_cast<float>(view.silhouette_weight)),
      coarse_outside_(view.coarse_outside),
      coarse_backfaces_(view.coarse_backfaces),
      uses_cones_(view.coarse_backfaces || view.silhouette_weight != 1),
      uses_more_(uses_cones_ || view.degrees > 0) {
  const Camera& camera = view.camera;
  const double half = std::tan(radians(camera.vertical_fov_deg) / 2);
  const double wide = half * camera.width_px / camera.height_px;
  pixels_per_radian_ = static_cast<float>(camera.height_px / (2 * half));
  pixels_at_one_ = pixels_per_radian_ / static_cast<float>(std::max(view.camera.pixels, 1e-12));
  const Vec3d forward = normalized(camera.target - camera.position);
  const Vec3d right = normalized(cross(forward, camera.up));
  const Vec3d up = cross(right, forward);
  planes_ = {as_float(forward), as_float(normalized(forward * wide + right)),
             as_float(normalized(forward * wide - right)),
             as_float(normalized(forward * half + up)), as_float(normalized(forward * half - up))};
}

// For every camera up to `leeway` away: the largest if it is positive, the smallest if negative.
float ViewError::excess_within(const SplitBounds& bounds, const Vec3f& to, float distance,
                               float leeway) const {
  const float true_radius = decoded(bounds.radius);
  const float radius = true_radius + leeway;
  const float nearest = std::max(distance - radius, 1e-20f);
  const float error = std::max(decoded(bounds.surface), decoded(bounds.line));
  float excess = error > 0 ? std::min(error * pixels_at_one_ / nearest, kMost) : 0;
  if (per_degree_ > 0) {
    const float pixels = 2 * true_radius * pixels_per_radian_ / nearest;
    const float size = std::min(1.0f, pixels / kFullSizePixels);
    excess = std::max(excess, decoded(bounds.degrees) * per_degree_ * size);
  }
  if (uses_cones_ && excess > 0) excess *= weight_of_facing(bounds, to, distance, radius);
  return excess;
}

float ViewError::see_more(const SplitBounds& bounds, const Vec3f& to, float distance, float limit,
                          float& excess) const {
  excess = excess_within(bounds, to, distance, 0);
  const bool is_more = excess > limit;
  for (const float share : {0.3f, 0.1f, 0.03f, 0.01f}) {
    const float leeway = is_more ? -share * distance : share * distance;
    if ((excess_within(bounds, to, distance, leeway) > limit) == is_more) return share * distance;
  }
  return 0;
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
