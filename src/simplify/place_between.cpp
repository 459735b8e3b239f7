#include "simplify/place_between.h"

#include "hierarchy/between.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace crease::simplification {

namespace {

// A place costs a file more bits if it is not in the middle, and if its steps are not along the
// axis that is nearest to the normal: then it must be cheaper by this.
constexpr double kOffMiddle = 0.9, kOffAxis = 0.9;

Vec3d half_gradient(const Quadric& q, const Vec3d& x) {
  const Row t = x.x * q.row[0] + x.y * q.row[1] + x.z * q.row[2];
  return {t[0] + q.row[0][3], t[1] + q.row[1][3], t[2] + q.row[2][3]};
}

// between_step() of whole numbers, and its inverse.
struct Step {
  double size = 1, inverse = 1;
};
Step step_of(double apart_first, double apart_second) {
  const double apart = std::max(std::abs(apart_first), std::abs(apart_second));
  const int width = static_cast<int>(std::bit_cast<std::uint64_t>(apart) >> 52) - 1022;
  if (width <= kBetweenBits) return {};
  const auto power = [](int n) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + n) << 52);
  };
  return {power(width - kBetweenBits), power(kBetweenBits - width)};
}

// A place that the search considers: how far along the way, and from there along an axis.
struct Considered {
  int eighths = 4;
  int axis = 0;
  double away = 0;  // along the axis: whole steps
  double cost = 0;  // but for what rounding to the grid changes
};

// The quadric along the way from a to b and, from there, along an axis.
struct Way {
  Vec3d along, slope_at_a, slope_grows;  // half the gradient
  double cost_at_a, first, second;       // the cost is cost_at_a + 2 first s + second s s
  Vec3d stiff;                           // along each axis
  double farthest2;                      // along an axis, squared

  Way(const Quadric& sum, const Vec3d& a, const Vec3d& b, double cost, double pull)
      : along(b - a),
        slope_at_a(half_gradient(sum, a)),
        slope_grows(half_gradient(sum, b) - slope_at_a),
        cost_at_a(cost),
        first(dot(slope_at_a, along)),
        second(dot(slope_grows, along)),
        farthest2(dot(along, along)) {
    const double mu = pull * sum.trace();
    stiff = {sum.row[0][0] + mu, sum.row[1][1] + mu, sum.row[2][2] + mu};
  }

  int steepest() const {
    const int axis = stiff.x >= stiff.y ? 0 : 1;
    return stiff[axis] >= stiff.z ? axis : 2;
  }

  // The best eighth when every place goes along `axis` as far as it likes.
  int best_eighths(int axis) const {
    const double part = slope_grows[axis] / stiff[axis];
    const double rest = second - slope_grows[axis] * part;
    if (!(rest > 0)) return 4;
    const double where = (slope_at_a[axis] * part - first) / rest;
    return static_cast<int>(rounded(std::clamp(8 * where, 1.0, 7.0)));
  }

  Considered consider(int eighths, int axis) const {
    const double s = eighths / 8.0;
    const double slope = slope_at_a[axis] + slope_grows[axis] * s;
    const double still = cost_at_a + s * (2 * first + second * s);
    const Step step = step_of(along[(axis + 1) % 3], along[(axis + 2) % 3]);
    const double steps = rounded(-slope / stiff[axis] * step.inverse), away = steps * step.size;
    // Or one that is too far off, or not a number.
    if (!(std::abs(steps) <= kMostSteps && away * away <= farthest2)) {
      return {eighths, axis, 0, still};
    }
    return {eighths, axis, away, still + away * (2 * slope + away * stiff[axis])};
  }
};

}  // namespace

CREASE_WIDE PlaceBetween place_between(const Quadric& sum, const Vec3d& a, const Vec3d& b,
                                       double cost_at_a, double pull) {
  const Way way(sum, a, b, cost_at_a, pull);
  const int steepest = way.steepest();
  Considered best{4, steepest, 0, 0};
  if (way.stiff[steepest] > 0) {
    best = way.consider(4, steepest);
    double least = best.cost;
    if (const int other = way.best_eighths(steepest); other != 4) {
      const Considered there = way.consider(other, steepest);
      if (there.cost < kOffMiddle * least) best = there, least = there.cost / kOffMiddle;
    }
    const double share = kOffAxis * (best.eighths == 4 ? 1 : kOffMiddle);
    for (const int turn : {1, 2}) {
      const int axis = (steepest + turn) % 3;
      if (!(way.stiff[axis] > 0)) continue;
      const Considered there = way.consider(best.eighths, axis);
      if (there.cost < share * least) best = there, least = there.cost / share;
    }
  }
  Vec3d place;
  for (int i = 0; i < 3; ++i) {
    place[i] = static_cast<double>(between_ends(static_cast<std::int64_t>(a[i]),
                                                static_cast<std::int64_t>(b[i]), best.eighths));
  }
  place[best.axis] += best.away;
  return {place, sum.at(place)};
}

}  // namespace crease::simplification
