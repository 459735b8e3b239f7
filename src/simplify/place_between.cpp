#include "simplify/place_between.h"

#include "hierarchy/between.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crease::simplification {

namespace {

// A place costs a file more bits if it is not in the middle, and if its steps are not along the
// axis that is nearest to the normal: then it must be cheaper by this.
constexpr double kOffMiddle = 0.95, kOffAxis = 0.8;

struct Search {
  const Quadric& sum;
  const Vec3d &a, &b;
  double pull;  // added to what a step costs
  PlaceBetween best{{}, std::numeric_limits<double>::infinity()};
  double best_rated = best.cost;
  int best_eighths = 4;

  Vec3d half_gradient(const Vec3d& x) const {
    const Row t = x.x * sum.row[0] + x.y * sum.row[1] + x.z * sum.row[2];
    return {t[0] + sum.row[0][3], t[1] + sum.row[1][3], t[2] + sum.row[2][3]};
  }

  // Where from a to b the best place is, in eighths, when every place goes along `axis` as far as
  // it likes.
  int likely_eighths(int axis) const {
    const Vec3d along = b - a, at_a = half_gradient(a);
    const Vec3d slope = half_gradient(b) - at_a;
    const double stiff = sum.row[axis][axis] + pull;
    const double first = dot(at_a, along) - at_a[axis] * slope[axis] / stiff;
    const double second = dot(along, slope) - slope[axis] * slope[axis] / stiff;
    if (!(second > 0)) return 4;
    return static_cast<int>(std::clamp(std::round(-8 * first / second), 1.0, 7.0));
  }

  void look_at(int eighths, int axis, double share) {
    Vec3d place;
    for (int i = 0; i < 3; ++i) {
      place[i] = static_cast<double>(
          between_ends(static_cast<std::int64_t>(a[i]), static_cast<std::int64_t>(b[i]), eighths));
    }
    const auto apart = [&](int i) { return static_cast<std::int64_t>(b[i % 3] - a[i % 3]); };
    const double step = static_cast<double>(between_step(apart(axis + 1), apart(axis + 2)));
    const double away = -half_gradient(place)[axis] / (sum.row[axis][axis] + pull);
    const double most = std::min(length(b - a), step * kMostSteps);
    if (std::abs(away) <= most) place[axis] += std::round(away / step) * step;
    const double cost = sum.at(place), rated = cost / share;
    if (rated < best_rated) {
      best = {place, cost};
      best_rated = rated;
      best_eighths = eighths;
    }
  }
};

}  // namespace

PlaceBetween place_between(const Quadric& sum, const Vec3d& a, const Vec3d& b, double pull) {
  Search search{sum, a, b, pull * sum.trace()};
  if (!(search.pull > 0)) {
    search.look_at(4, 2, 1);
    return search.best;
  }
  int steepest = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (sum.row[axis][axis] > sum.row[steepest][steepest]) steepest = axis;
  }
  search.look_at(4, steepest, 1);
  const int eighths = search.likely_eighths(steepest);
  if (eighths != 4) search.look_at(eighths, steepest, kOffMiddle);
  const int found = search.best_eighths;
  const double off_middle = found == 4 ? 1 : kOffMiddle;
  search.look_at(found, (steepest + 1) % 3, kOffAxis * off_middle);
  search.look_at(found, (steepest + 2) % 3, kOffAxis * off_middle);
  return search.best;
}

}  // namespace crease::simplification
