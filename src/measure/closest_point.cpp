#include "measure/closest_point.h"

#include <algorithm>

namespace crease {

namespace {

// Where on the segment a..b (0 at a, 1 at b) the closest point lies.
double along_segment(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d ab = b - a;
  const double squared_length = dot(ab, ab);
  return squared_length > 0 ? std::clamp(dot(p - a, ab) / squared_length, 0.0, 1.0) : 0.0;
}

// Whether ab is shorter than what it is the base of, in a needle: digits would be lost.
bool needs_longer_base(const Vec3d& a, const Vec3d& b, const Vec3d& c, double squared_height) {
  constexpr double kThin = 1e-6;  // squared
  const Vec3d ab = b - a, bc = c - b, ca = a - c;
  const double base = dot(ab, ab), longest = std::max(dot(bc, bc), dot(ca, ca));
  return base < longest && std::min(squared_height, base) < kThin * longest;
}

}  // namespace

ClosestPoint closest_point(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a;
  // ac = ab * lean + height, height orthogonal to ab: in this frame the error grows with the aspect
  // ratio; with the usual determinant of dot products it would grow with its square.
  const double base = dot(ab, ab);
  if (base > 0) {
    const double lean = dot(ac, ab) / base;
    const Vec3d height = ac - ab * lean;
    const double squared_height = dot(height, height);
    if (needs_longer_base(a, b, c, squared_height)) {  // at most twice: the longest never does
      const ClosestPoint turned = closest_point(p, b, c, a);
      return {turned.squared_distance, {turned.weights[2], turned.weights[0], turned.weights[1]}};
    }
    if (squared_height > 0) {
      const double w = dot(ap, height) / squared_height;
      const double v = dot(ap, ab) / base - w * lean;
      if (v >= 0 && w >= 0 && v + w <= 1) {
        const Vec3d d = ap - ab * v - ac * w;
        return {dot(d, d), {1 - v - w, v, w}};
      }
    }
  }
  const std::array<Vec3d, 3> corner{a, b, c};
  ClosestPoint best{.squared_distance = -1};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double s = along_segment(p, corner[i], corner[j]);
    const Vec3d d = (p - corner[i]) - (corner[j] - corner[i]) * s;
    const double squared_distance = dot(d, d);
    if (best.squared_distance >= 0 && squared_distance >= best.squared_distance) continue;
    best.squared_distance = squared_distance;
    best.weights = {};
    best.weights[i] = 1 - s;
    best.weights[j] = s;
  }
  return best;
}

}  // namespace crease
