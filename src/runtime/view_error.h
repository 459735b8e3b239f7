// How visible a split is from a camera: the criteria of DESIGN 8 as one number.
//
//   ViewError error(view, grid);
//   if (error.of(bounds, position) > 1) split
//
// Like the bounds it is made of, the number never grows on the way down: errors shrink, spheres and
// cones are nested. So what is split because of it is split from the root on.
#pragma once

#include "crease/adaptive_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crease {

class ViewError {
 public:
  ViewError() = default;
  ViewError(const ViewParameters& view, const Grid& grid);

  // `position` in model units from the grid's origin. 1: just what is allowed. `leeway` answers for
  // every camera up to that far away: the largest number if it is positive, the smallest one if it
  // is negative.
  float of(const SplitBounds& bounds, const Vec3f& position, float leeway = 0) const {
    const Vec3f to = position - eye_;
    const float true_radius = bounds.radius.value();
    const float radius = true_radius + leeway;
    if (coarse_outside_) {
      for (const Vec3f& inwards : planes_) {
        if (dot(inwards, to) < -radius) return 0;
      }
    }
    const float distance = length(to);
    const float nearest = std::max(distance - radius, 1e-20f);
    const float error = std::max(bounds.surface.value(), bounds.line.value());
    const float scale = pixels_per_radian_ / nearest;
    float excess = error > 0 ? std::min(error * scale * per_pixel_, kMost) : 0;
    if (per_degree_ > 0) {
      const float size = std::min(1.0f, 2 * true_radius * scale / kFullSizePixels);
      excess = std::max(excess, bounds.degrees.value() * per_degree_ * size);
    }
    if (uses_cones_ && excess > 0) excess *= weight_of_facing(bounds, to, distance, radius);
    return excess;
  }

  float distance(const Vec3f& position) const { return length(position - eye_); }
  Vec3f position(const Vec3i& g) const {
    return {static_cast<float>(step_ * g.x), static_cast<float>(step_ * g.y),
            static_cast<float>(step_ * g.z)};
  }

 private:
  static constexpr float kFullSizePixels = 16;
  static constexpr float kMost = 1e30f;  // where the camera is inside the sphere

  // 0 if all of it faces away, more than 1 if it faces both ways.
  float weight_of_facing(const SplitBounds& bounds, const Vec3f& to, float distance,
                         float radius) const;

  Vec3f eye_;
  std::array<Vec3f, 5> planes_{};  // through the eye: four sides and what is behind it
  double step_ = 1;
  float pixels_per_radian_ = 1, per_pixel_ = 1, per_degree_ = 0, silhouette_weight_ = 1;
  bool coarse_outside_ = true, coarse_backfaces_ = false, uses_cones_ = false;
};

}  // namespace crease
