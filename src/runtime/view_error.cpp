#include "runtime/view_error.h"

#include "runtime/view_frame.h"

#include <algorithm>

namespace crease {

ViewError::ViewError(const ViewParameters& view, const Grid& grid)
    : step_(grid.step),
      per_degree_(view.degrees > 0 ? static_cast<float>(1 / view.degrees) : 0.0f),
      silhouette_weight_(static_cast<float>(view.silhouette_weight)),
      coarse_backfaces_(view.coarse_backfaces),
      uses_cones_(view.coarse_backfaces || view.silhouette_weight != 1) {
  const Camera& camera = view.camera;
  const double half = std::tan(radians(camera.vertical_fov_deg) / 2);
  const double wide = half * camera.width_px / camera.height_px;
  const auto pixels_per_radian = static_cast<float>(camera.height_px / (2 * half));
  pixels_at_one_ = pixels_per_radian / static_cast<float>(std::max(view.camera.pixels, 1e-12));
  full_size_at_one_ = 2 * pixels_per_radian / kFullSizePixels;
  const auto [forward, right, up] = view_frame(camera);
  const auto set = [](std::array<float, 3>& to, const Vec3d& from) {
    to = {static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
  };
  // The distance from a side is dot(forward * wide + right, to) / |forward * wide + right|.
  const double wide_length = std::hypot(wide, 1), high_length = std::hypot(half, 1);
  frame_ = {camera.position, forward, right, up};
  set(gaze_.eye, camera.position - grid.origin);
  set(gaze_.forward, forward);
  set(gaze_.right, right * (1 / wide_length));
  set(gaze_.up, up * (1 / high_length));
  gaze_.wide_forward = static_cast<float>(wide / wide_length);
  gaze_.high_forward = static_cast<float>(half / high_length);
  gaze_.outside = view.coarse_outside ? 0 : kNever;
  const auto spread = [](float x) { return FourFloats{x, x, x, x}; };
  for (std::size_t i = 0; i < 3; ++i) {
    gaze4_.eye[i] = spread(gaze_.eye[i]);
    gaze4_.forward[i] = spread(gaze_.forward[i]);
    gaze4_.right[i] = spread(gaze_.right[i]);
    gaze4_.up[i] = spread(gaze_.up[i]);
  }
  gaze4_.wide_forward = spread(gaze_.wide_forward);
  gaze4_.high_forward = spread(gaze_.high_forward);
  gaze4_.outside = spread(gaze_.outside);
}

void ViewError::look_aside(const SplitBounds& bounds, float limit, Watch& watch) const {
  watch.reach_aside = reach_for(bounds, silhouette_weight_, limit);
  if (bounds.cone_angle >= 128) return;
  const NormalCone cone = bounds.cone();
  watch.axis = cone.axis;
  watch.sine = std::sin(cone.half_angle_rad);
  watch.cosine = std::max(0.0f, std::cos(cone.half_angle_rad));
}

// As in reach_for() of a sphere without a cone.
ViewError::Reaches ViewError::reaches(float limit) const {
  const float weight = (uses_cones_ ? std::max(silhouette_weight_, 0.0f) : 1) / limit;
  const float turned = per_degree_ * weight;
  return {pixels_at_one_ * weight, turned * full_size_at_one_, turned > 0 ? 1 / turned : kNever};
}

// Directions change by at most the root of the sum of squares that the frame's three do, over the
// root of 2.
ViewError::Motion ViewError::motion_from(const ViewError& before) const {
  double sum = 0;
  for (std::size_t i = 1; i < frame_.size(); ++i) {
    const Vec3d change = frame_[i] - before.frame_[i];
    sum += dot(change, change);
  }
  return {length(frame_[0] - before.frame_[0]), std::sqrt(sum / 2)};
}

float ViewError::of(const SplitBounds& bounds, const Vec3f& position, float least_radii) const {
  const Watch w = watch(bounds, position, 1);
  const Vec3f& c = w.center;
  if (inside(c.x, c.y, c.z) + w.radius < 0) return 0;
  const float least = std::max(least_radii * w.radius, 1e-20f);
  const float nearest = std::max(distance(c.x, c.y, c.z) - w.radius, least);
  const float error = std::max(decoded(bounds.surface), decoded(bounds.line));
  float excess = error > 0 ? std::min(error * pixels_at_one_ / nearest, kMost) : 0;
  const float size = std::min(1.0f, w.radius * full_size_at_one_ / nearest);
  excess = std::max(excess, decoded(bounds.degrees) * per_degree_ * size);
  if (!uses_cones_) return excess;
  // Which of three reaches is chosen tells the weight.
  const float weight = facing_reach(c.x, c.y, c.z, 1.0f, w.radius, w.axis.x, w.axis.y, w.axis.z,
                                    w.sine, w.cosine, silhouette_weight_);
  return excess * std::max(weight, 0.0f);
}

}  // namespace crease
