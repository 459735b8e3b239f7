// How wrong a vertex is seen to be from a camera: the criteria of a view as one number, and as a
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

#include "base/four_floats.h"
#include "crease/adaptive_mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace crease {

inline bool any(const FourInts& lanes) {
  using Long2 [[gnu::vector_size(16)]] = std::int64_t;
  const auto halves = std::bit_cast<Long2>(lanes);
  return (halves[0] | halves[1]) != 0;
}

inline float magnitude(float x) {
  return std::fabs(x);
}
inline FourFloats magnitude(const FourFloats& x) {
  return std::bit_cast<FourFloats>(std::bit_cast<FourInts>(x) & 0x7fffffff);
}

inline float lesser(float a, float b) {
  return a < b ? a : b;
}
inline float least(const FourFloats& x) {
  const FourFloats pairs = lesser(x, FourFloats{x[2], x[3], x[0], x[1]});
  return lesser(pairs[0], pairs[1]);
}

inline float root(float x) {
  return std::sqrt(x);
}

inline constexpr float kNever = std::numeric_limits<float>::infinity();

// Never wrong, as it is here.
struct Watch {
  Vec3f center;
  float reach = -kNever;  // it is wrong for eyes within this distance
  float radius = 0;       // of the sphere that has to be in view
  // Where facing counts: normals are within an angle of so much sine and cosine around the axis.
  // Cosine 0: any direction.
  Vec3f axis;
  float sine = 1, cosine = 0;
  float reach_aside = -kNever;  // in place of reach for what may be a silhouette
};

// Wrong for every eye.
inline constexpr Watch kAlwaysWrong{{}, kNever, kNever, {}, 1, 0, kNever};

// To say which of the spheres around the eye are worst, something in them is so near.
inline constexpr float kNearestRadii = 0.05f;

class ViewError {
 public:
  ViewError() = default;
  ViewError(const ViewParameters& view, const Grid& grid);

  // `position` in model units from the grid's origin. 1: just what is allowed. The eye counts as no
  // nearer to the sphere than so many of its radii: with 0, from inside any error is far too large.
  float of(const SplitBounds& bounds, const Vec3f& position, float least_radii = 0) const;

  // For the question "is it more than `limit`?".
  Watch watch(const SplitBounds& bounds, const Vec3f& position, float limit) const;

  bool is_wrong(const Watch& watch) const;

  // The same in parts, where several errors are asked of one sphere, which has no cone, as those of
  // blocks have none.
  struct Reaches {  // for one limit
    float per_off = 0, per_turned = 0, least_turned = 0;
  };
  Reaches reaches(float limit) const;
  // How far around the sphere it is wrong. `off`: the larger one of surface and line.
  float reach(RoundedUp off, RoundedUp degrees, float radius, const Reaches& reaches) const {
    float reach = decoded(off) * reaches.per_off;
    if (per_degree_ > 0 && decoded(degrees) > reaches.least_turned) {
      reach = std::max(reach, decoded(degrees) * reaches.per_turned * radius);
    }
    return reach;
  }
  float distance2(const Vec3f& p) const {
    const float x = p.x - gaze_.eye[0], y = p.y - gaze_.eye[1], z = p.z - gaze_.eye[2];
    return x * x + y * y + z * z;
  }
  static bool is_near(float reach, float radius, float distance2) {
    return reach > 0 && (reach + radius) * (reach + radius) > distance2;
  }
  bool is_in_view(const Vec3f& p, float radius) const {
    return inside(p.x, p.y, p.z) + radius >= 0;
  }
  // As RoundedUp::value(), here for speed.
  static float decoded(RoundedUp f) { return std::bit_cast<float>(std::uint32_t(f.bits) << 15); }

  // The same for a number or for four, in parts: wrong is what is nearer than its reach and whose
  // sphere is in view, that is, not in front of any of five planes through the eye by more than the
  // radius.
  template <typename Real>
  Real distance(const Real& x, const Real& y, const Real& z) const {
    const Gaze<Real>& g = gaze_for(Real{});
    const Real to_x = x - g.eye[0], to_y = y - g.eye[1], to_z = z - g.eye[2];
    return root(to_x * to_x + to_y * to_y + to_z * to_z);
  }
  // How far inside the nearest plane, or outside the farthest one if negative.
  template <typename Real>
  Real inside(const Real& x, const Real& y, const Real& z) const {
    const Gaze<Real>& g = gaze_for(Real{});
    const Real to_x = x - g.eye[0], to_y = y - g.eye[1], to_z = z - g.eye[2];
    const auto along = [&](const std::array<Real, 3>& axis) {
      return Real(to_x * axis[0] + to_y * axis[1] + to_z * axis[2]);
    };
    const Real ahead = along(g.forward);
    const Real across = g.wide_forward * ahead - magnitude(along(g.right));
    const Real upright = g.high_forward * ahead - magnitude(along(g.up));
    return g.outside + lesser(ahead, lesser(across, upright));
  }
  template <typename Real>
  Real facing_reach(const Real& x, const Real& y, const Real& z, const Real& reach,
                    const Real& radius, const Real& axis_x, const Real& axis_y, const Real& axis_z,
                    const Real& sine, const Real& cosine, const Real& reach_aside) const;

  // What moves between two views that differ in the camera's place and direction alone: the eye,
  // and any direction that is fixed in the picture, at most.
  struct Motion {
    double travel, turn;
  };
  Motion motion_from(const ViewError& before) const;
  float eye_length() const { return std::hypot(gaze_.eye[0], gaze_.eye[1], gaze_.eye[2]); }

  bool uses_cones() const { return uses_cones_; }
  Vec3f position(const Vec3i& g) const {
    return {static_cast<float>(step_ * g.x), static_cast<float>(step_ * g.y),
            static_cast<float>(step_ * g.z)};
  }

 private:
  static constexpr float kFullSizePixels = 16;
  static constexpr float kMost = 1e30f;  // where the camera is inside the sphere

  float reach_for(const SplitBounds& bounds, float weight, float limit) const;
  // What facing adds to a watch.
  void look_aside(const SplitBounds& bounds, float limit, Watch& watch) const;

  // The view as numbers to compute with. The frustum has five planes through the eye: four sides
  // and what is behind it. Those that are opposite differ in a sign; `right` and `up` are scaled so
  // that the differences below are distances from the planes.
  template <typename Real>
  struct Gaze {
    std::array<Real, 3> eye{}, forward{}, right{}, up{};
    Real wide_forward{}, high_forward{};
    Real outside{};  // 0, or infinity if what is outside counts as well
  };
  const Gaze<float>& gaze_for(float) const { return gaze_; }
  const Gaze<FourFloats>& gaze_for(const FourFloats&) const { return gaze4_; }

  Gaze<float> gaze_;
  Gaze<FourFloats> gaze4_;
  std::array<Vec3d, 4> frame_{};  // eye, forward, right, up
  double step_ = 1;
  float pixels_at_one_ = 1;  // a length of 1 at distance 1, in pixels that are allowed
  // Shading of a sphere at distance 1 that is off by one degree, per radius and degree allowed,
  // while it is smaller than its full size.
  float full_size_at_one_ = 1;
  float per_degree_ = 0, silhouette_weight_ = 1;
  bool coarse_backfaces_ = false, uses_cones_ = false;
};

inline float ViewError::reach_for(const SplitBounds& bounds, float weight, float limit) const {
  const float radius = decoded(bounds.radius);
  const float error = std::max(decoded(bounds.surface), decoded(bounds.line)) * pixels_at_one_;
  const float turned = decoded(bounds.degrees) * per_degree_;
  float reach = error * weight / limit;
  if (turned * weight > limit) {
    reach = std::max(reach, turned * weight / limit * radius * full_size_at_one_);
  }
  return reach > 0 ? reach + radius : -kNever;
}

inline Watch ViewError::watch(const SplitBounds& bounds, const Vec3f& position, float limit) const {
  Watch watch;
  watch.center = position;
  watch.radius = decoded(bounds.radius);
  watch.reach = reach_for(bounds, 1, limit);
  if (uses_cones_) look_aside(bounds, limit, watch);
  return watch;
}

inline bool ViewError::is_wrong(const Watch& w) const {
  const Vec3f& c = w.center;
  const float reach = uses_cones_
                          ? facing_reach(c.x, c.y, c.z, w.reach, w.radius, w.axis.x, w.axis.y,
                                         w.axis.z, w.sine, w.cosine, w.reach_aside)
                          : w.reach;
  return distance(c.x, c.y, c.z) < reach && inside(c.x, c.y, c.z) + w.radius >= 0;
}

// Which of the two reaches counts, by how the sphere's normals face the eye. All directions from
// the eye to the sphere and all normals differ from the axes by half_angle + asin(radius /
// distance) at most; here by sines and cosines of these angles, times the distance.
template <typename Real>
Real ViewError::facing_reach(const Real& x, const Real& y, const Real& z, const Real& reach,
                             const Real& radius, const Real& axis_x, const Real& axis_y,
                             const Real& axis_z, const Real& sine, const Real& cosine,
                             const Real& reach_aside) const {
  const Gaze<Real>& g = gaze_for(Real{});
  const Real to_x = x - g.eye[0], to_y = y - g.eye[1], to_z = z - g.eye[2];
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
  const Real away = coarse_backfaces_ ? Real{} - kNever : reach;
  return is_away ? away : is_towards ? reach : reach_aside;
}

}  // namespace crease
