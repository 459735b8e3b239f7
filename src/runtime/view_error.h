// How wrong a vertex is seen to be from a camera: the criteria of DESIGN 8 as one number, and as a
// question that takes a few instructions.
//
//   ViewError error(view, grid);
//   error.of(bounds, position)                              // 1: just what is allowed
//   const Watch watch = error.watch(bounds, position, 1);   // good while only the camera moves
//   if (error.is_wrong(watch)) split
//
// A surface that is off by e is seen to be off by more than what is allowed iff the eye is nearer
// to the sphere that holds it than some length, which depends on e and on the sizes of pixels
// alone; so is shading. Hence a watch: the sphere, and how far around its centre it reaches.
//
// Like the bounds it is made of, the number never grows on the way down: errors shrink, spheres and
// cones are nested. So what is split because of it is split from the root on.
#pragma once

#include "crease/adaptive_mesh.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace crease {

using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;

inline bool any(const Int4& lanes) {
  using Long2 [[gnu::vector_size(16)]] = std::int64_t;
  const Long2 halves = reinterpret_cast<const Long2&>(lanes);
  return (halves[0] | halves[1]) != 0;
}

// Never wrong, as it is here.
struct Watch {
  Vec3f center;
  float reach2 = -1;  // squared: it is wrong for eyes within this distance
  float radius = 0;   // of the sphere that has to be in view
  // Where facing counts: normals are within an angle of so much sine and cosine around the axis.
  // Cosine 0: any direction.
  Vec3f axis;
  float sine = 1, cosine = 0;
  float reach2_aside = -1;  // in place of reach2 for what may be a silhouette
};

class ViewError {
 public:
  ViewError() = default;
  ViewError(const ViewParameters& view, const Grid& grid);

  // `position` in model units from the grid's origin. 1: just what is allowed.
  float of(const SplitBounds& bounds, const Vec3f& position) const;

  // For the question "is it more than `limit`?".
  Watch watch(const SplitBounds& bounds, const Vec3f& position, float limit) const;

  bool is_wrong(const Watch& watch) const;

  // The same for a number or for four.
  template <typename Real>
  auto is_wrong(const Real& x, const Real& y, const Real& z, const Real& reach2,
                const Real& radius) const {
    const Real to_x = x - eye_.x, to_y = y - eye_.y, to_z = z - eye_.z;
    const auto is_near = to_x * to_x + to_y * to_y + to_z * to_z < reach2;
    Real inside = to_x * planes_[0].x + to_y * planes_[0].y + to_z * planes_[0].z;
    for (std::size_t i = 1; i < planes_.size(); ++i) {
      const Real other = to_x * planes_[i].x + to_y * planes_[i].y + to_z * planes_[i].z;
      inside = inside < other ? inside : other;
    }
    return is_near & (inside + (radius + leeway_) >= 0);
  }
  template <typename Real>
  Real reach2(const Real& x, const Real& y, const Real& z, const Real& reach2, const Real& radius,
              const Real& axis_x, const Real& axis_y, const Real& axis_z, const Real& sine,
              const Real& cosine, const Real& reach2_aside) const;

  bool uses_cones() const { return uses_cones_; }
  Vec3f position(const Vec3i& g) const {
    return {static_cast<float>(step_ * g.x), static_cast<float>(step_ * g.y),
            static_cast<float>(step_ * g.z)};
  }

 private:
  static constexpr float kFullSizePixels = 16;
  static constexpr float kMost = 1e30f;  // where the camera is inside the sphere

  // As RoundedUp::value(), here for speed.
  static float decoded(RoundedUp f) { return std::bit_cast<float>(std::uint32_t(f.bits) << 15); }

  Vec3f eye_;
  std::array<Vec3f, 5> planes_{};  // through the eye: four sides and what is behind it
  float leeway_ = 0;               // infinite if what is outside counts as well
  double step_ = 1;
  float pixels_at_one_ = 1;  // a length of 1 at distance 1, in pixels that are allowed
  // Shading of a sphere at distance 1 that is off by one degree, per radius and degree allowed,
  // while it is smaller than its full size.
  float full_size_at_one_ = 1;
  float per_degree_ = 0, silhouette_weight_ = 1;
  bool coarse_backfaces_ = false, uses_cones_ = false;
};

inline bool ViewError::is_wrong(const Watch& w) const {
  const Vec3f& c = w.center;
  const float reach = uses_cones_ ? reach2(c.x, c.y, c.z, w.reach2, w.radius, w.axis.x, w.axis.y,
                                           w.axis.z, w.sine, w.cosine, w.reach2_aside)
                                  : w.reach2;
  return is_wrong<float>(c.x, c.y, c.z, reach, w.radius);
}

// Which of the two reaches counts, by how the sphere's normals face the eye. All directions from
// the eye to the sphere and all normals differ from the axes by half_angle + asin(radius /
// distance) at most; here by sines and cosines of these angles, times the distance.
template <typename Real>
Real ViewError::reach2(const Real& x, const Real& y, const Real& z, const Real& reach2,
                       const Real& radius, const Real& axis_x, const Real& axis_y,
                       const Real& axis_z, const Real& sine, const Real& cosine,
                       const Real& reach2_aside) const {
  const Real to_x = x - eye_.x, to_y = y - eye_.y, to_z = z - eye_.z;
  const Real behind2 = to_x * to_x + to_y * to_y + to_z * to_z - radius * radius;
  const Real tangent2 = behind2 > 0 ? behind2 : behind2 * 0;  // to where a ray touches the sphere
  const Real facing = to_x * axis_x + to_y * axis_y + to_z * axis_z;
  // facing > sin(a + b) * distance, without a root: what is squared is positive.
  const Real more = facing - cosine * radius, less = -facing - cosine * radius;
  const Real sine2 = sine * sine * tangent2;
  // a + b < 90 degrees.
  const auto is_narrow =
      (behind2 > 0) & (cosine > 0) & (cosine * cosine * tangent2 > sine * sine * (radius * radius));
  const auto is_away = is_narrow & (more > 0) & (more * more > sine2);
  const auto is_towards = is_narrow & (less > 0) & (less * less > sine2);
  const Real away = coarse_backfaces_ ? reach2 * 0 - 1 : reach2;
  return is_away ? away : is_towards ? reach2 : reach2_aside;
}

}  // namespace crease
