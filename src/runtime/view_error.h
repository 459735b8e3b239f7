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
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace crease {

class ViewError {
 public:
  ViewError() = default;
  ViewError(const ViewParameters& view, const Grid& grid);

  // `position` in model units from the grid's origin. 1: just what is allowed.
  float of(const SplitBounds& bounds, const Vec3f& position) const {
    return see(bounds, position, 1).excess;
  }

  // The same, and how far the camera may go before the answer to "is it more than `limit`?" can
  // change: either way, `travel` by moving alone, `swing` by moving and turning together, where to
  // turn moves a point by the angle times its distance.
  struct Sight {
    float excess, distance, travel, swing;
  };
  Sight see(const SplitBounds& bounds, const Vec3f& position, float limit) const {
    const Vec3f to = position - eye_;
    const float distance = length(to);
    const float radius = decoded(bounds.radius);
    const float error = std::max(decoded(bounds.surface), decoded(bounds.line));
    const float nearest = std::max(distance - radius, 1e-20f);
    float excess = error > 0 ? std::min(error * pixels_at_one_ / nearest, kMost) : 0;
    float travel = std::fabs(distance - radius - error * pixels_at_one_ / limit);
    if (uses_more_) travel = std::min(travel, see_more(bounds, to, distance, limit, excess));
    if (!coarse_outside_ || excess <= limit) return {excess, distance, travel, kNever};
    float inside = kNever;  // of the plane that is nearest
    for (const Vec3f& inwards : planes_) inside = std::min(inside, dot(inwards, to) + radius);
    if (inside >= 0) return {excess, distance, travel, inside};
    return {0, distance, kNever, -inside};
  }

  float distance(const Vec3f& position) const { return length(position - eye_); }
  Vec3f position(const Vec3i& g) const {
    return {static_cast<float>(step_ * g.x), static_cast<float>(step_ * g.y),
            static_cast<float>(step_ * g.z)};
  }

 private:
  static constexpr float kFullSizePixels = 16;
  static constexpr float kMost = 1e30f;  // where the camera is inside the sphere
  static constexpr float kNever = std::numeric_limits<float>::infinity();

  // As RoundedUp::value(), here for speed.
  static float decoded(RoundedUp f) { return std::bit_cast<float>(std::uint32_t(f.bits) << 15); }

  // Shading and normal cones: corrects `excess`, returns the travel.
  float see_more(const SplitBounds& bounds, const Vec3f& to, float distance, float limit,
                 float& excess) const;
  float excess_within(const SplitBounds& bounds, const Vec3f& to, float distance,
                      float leeway) const;
  // 0 if all of it faces away, more than 1 if it faces both ways.
  float weight_of_facing(const SplitBounds& bounds, const Vec3f& to, float distance,
                         float radius) const;

  Vec3f eye_;
  std::array<Vec3f, 5> planes_{};  // through the eye: four sides and what is behind it
  double step_ = 1;
  float pixels_at_one_ = 1;  // a length of 1 at distance 1, in pixels that are allowed
  float pixels_per_radian_ = 1, per_degree_ = 0, silhouette_weight_ = 1;
  bool coarse_outside_ = true, coarse_backfaces_ = false, uses_cones_ = false, uses_more_ = false;
};

}  // namespace crease
