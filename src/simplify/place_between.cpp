#include "simplify/place_between.h"

#include "hierarchy/between.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace crease::simplification {

namespace {

// A place costs a file more bits if it is not in the middle, and if its steps are not along the
// axis that is nearest to the normal: then it must be cheaper by this.
constexpr double kOffMiddle = 0.95, kOffAxis = 0.8;

Vec3d half_gradient(const Quadric& q, const Vec3d& x) {
  const Row t = x.x * q.row[0] + x.y * q.row[1] + x.z * q.row[2];
  return {t[0] + q.row[0][3], t[1] + q.row[1][3], t[2] + q.row[2][3]};
}

// The quadric along the way from a to b and, from there, along an axis.
struct Way {
  Vec3d along, slope_at_a, slope_grows;  // half the gradient
  double cost_at_a, first, second;       // the cost is cost_at_a + 2 first s + second s s
  std::array<double, 3> stiff;           // along each axis
  std::array<double, 3> step;
  double farthest;  // along an axis

  Way(const Quadric& sum, const Vec3d& a, const Vec3d& b, double cost, double pull)
      : along(b - a), slope_at_a(half_gradient(sum, a)), cost_at_a(cost), farthest(length(along)) {
    slope_grows = half_gradient(sum, b) - slope_at_a;
    first = dot(slope_at_a, along);
    second = dot(slope_grows, along);
    const double mu = pull * sum.trace();
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const auto apart = [&](int axis) { return static_cast<std::int64_t>(along[axis % 3]); };
      stiff[i] = sum.row[k][k] + mu;
      step[i] = static_cast<double>(between_step(apart(k + 1), apart(k + 2)));
    }
  }

  std::size_t steepest() const {
    return static_cast<std::size_t>(std::max_element(stiff.begin(), stiff.end()) - stiff.begin());
  }

  // The best eighth when every place goes along `axis` as far as it likes.
  int best_eighths(std::size_t axis) const {
    const double part = slope_grows[int(axis)] / stiff[axis];
    const double rest = second - slope_grows[int(axis)] * part;
    if (!(rest > 0)) return 4;
    const double where = (slope_at_a[int(axis)] * part - first) / rest;
    return static_cast<int>(std::clamp(rounded(8 * where), 1.0, 7.0));
  }

  // How far to go along `axis` from there, in steps.
  double steps(int eighths, std::size_t axis) const {
    const double s = eighths / 8.0;
    const double slope = slope_at_a[int(axis)] + slope_grows[int(axis)] * s;
    const double away = -slope / stiff[axis];
    const double most = std::min(farthest, step[axis] * kMostSteps);
    return std::abs(away) <= most ? rounded(away / step[axis]) : 0;
  }

  double cost(int eighths, std::size_t axis) const {
    const double s = eighths / 8.0, away = steps(eighths, axis) * step[axis];
    const double slope = slope_at_a[int(axis)] + slope_grows[int(axis)] * s;
    return cost_at_a + s * (2 * first + second * s) + away * (2 * slope + away * stiff[axis]);
  }
};

}  // namespace

CREASE_WIDE PlaceBetween place_between(const Quadric& sum, const Vec3d& a, const Vec3d& b,
                                       double cost_at_a, double pull) {
  const Way way(sum, a, b, cost_at_a, pull);
  const std::size_t steepest = way.steepest();
  int eighths = 4;
  std::size_t axis = steepest;
  if (way.stiff[steepest] > 0) {
    double least = way.cost(4, axis);
    if (const int other = way.best_eighths(axis); other != 4) {
      const double cost = way.cost(other, axis) / kOffMiddle;
      if (cost < least) least = cost, eighths = other;
    }
    for (const std::size_t turn : {1u, 2u}) {
      const std::size_t other = (steepest + turn) % 3;
      const double cost = way.cost(eighths, other) / (kOffAxis * (eighths == 4 ? 1 : kOffMiddle));
      if (way.stiff[other] > 0 && cost < least) least = cost, axis = other;
    }
  }
  Vec3d place;
  for (int i = 0; i < 3; ++i) {
    place[i] = static_cast<double>(
        between_ends(static_cast<std::int64_t>(a[i]), static_cast<std::int64_t>(b[i]), eighths));
  }
  if (way.stiff[axis] > 0) place[int(axis)] += way.steps(eighths, axis) * way.step[axis];
  return {place, sum.at(place)};
}

}  // namespace crease::simplification
