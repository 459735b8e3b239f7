#include "simplify/place_between.h"

#include "hierarchy/between.h"

#include <algorithm>
#include <cstdint>

namespace crease::simplification {

namespace {

// A place costs a file more bits if it is not in the middle, and if its steps are not along the
// axis that is nearest to the normal: then it must be cheaper by this.
constexpr double kOffMiddle = 0.9, kOffAxis = 0.9;

using Bits = decltype(Row{} < Row{});

inline void take_absolute(const Row& x, Row& absolute) {
  absolute = reinterpret_cast<Row>(reinterpret_cast<Bits>(x) & INT64_MAX);
}

// As rounded(double).
inline void round_all(Row& x) {
  constexpr double kShift = 6755399441055744.0;
  x = (x + kShift) - kShift;
}

// The quadric along the way from a to b and, from there, along an axis. Rows are of the axes; what
// stands in their last lane means nothing.
struct Way {
  Row slope_at_a, slope_grows;      // half the gradient
  double cost_at_a, first, second;  // the cost is cost_at_a + 2 first s + second s s
  Row stiff;                        // along each axis
  Row step_size, step_inverse;      // between_step() along each axis
  double farthest2;                 // along an axis, squared

  Way(const Quadric& sum, const Vec3d& a, const Vec3d& b, double cost, double pull)
      : cost_at_a(cost) {
    const Row* q = sum.row;
    const Row linear = {q[0][3], q[1][3], q[2][3], q[2][3]};
    slope_at_a = (a.x * q[0] + a.y * q[1] + a.z * q[2]) + linear;
    slope_grows = ((b.x * q[0] + b.y * q[1] + b.z * q[2]) + linear) - slope_at_a;
    const Vec3d along = b - a;
    const auto dot_along = [&](const Row& x) { return dot(Vec3d{x[0], x[1], x[2]}, along); };
    first = dot_along(slope_at_a);
    second = dot_along(slope_grows);
    farthest2 = dot(along, along);
    const double mu = pull * sum.trace();
    stiff = Row{q[0][0], q[1][1], q[2][2], q[2][2]} + mu;

    Row one, other;
    take_absolute(Row{along.y, along.z, along.x, along.x}, one);
    take_absolute(Row{along.z, along.x, along.y, along.y}, other);
    const Row apart = one < other ? other : one;
    Bits shift = (reinterpret_cast<Bits>(apart) >> 52) - (1022 + kBetweenBits);
    shift = shift > 0 ? shift : Bits{};
    step_size = reinterpret_cast<Row>((1023 + shift) << 52);
    step_inverse = reinterpret_cast<Row>((1023 - shift) << 52);
  }

  int steepest() const {
    const int axis = stiff[0] >= stiff[1] ? 0 : 1;
    return stiff[axis] >= stiff[2] ? axis : 2;
  }

  // The best eighth when every place goes along `axis` as far as it likes.
  int best_eighths(int axis) const {
    const double part = slope_grows[axis] / stiff[axis];
    const double rest = second - slope_grows[axis] * part;
    if (!(rest > 0)) return 4;
    const double where = (slope_at_a[axis] * part - first) / rest;
    return static_cast<int>(rounded(std::clamp(8 * where, 1.0, 7.0)));
  }

  // The best places along each axis: how far, in whole steps, and the cost but for what rounding to
  // the grid changes.
  void consider(int eighths, Row& away, Row& cost) const {
    const double s = eighths / 8.0;
    const Row slope = slope_at_a + slope_grows * s;
    const double still = cost_at_a + s * (2 * first + second * s);
    Row steps = -slope / stiff * step_inverse, step_count;
    round_all(steps);
    take_absolute(steps, step_count);
    away = steps * step_size;
    // Or one that is too far off, or not a number.
    const Bits near = (step_count <= double(kMostSteps)) & (away * away <= farthest2);
    const Row moved = still + away * (2 * slope + away * stiff);
    away = near ? away : Row{};
    cost = near ? moved : Row{} + still;
  }
};

}  // namespace

CREASE_WIDE PlaceBetween place_between(const Quadric& sum, const Vec3d& a, const Vec3d& b,
                                       double cost_at_a, double pull) {
  const Way way(sum, a, b, cost_at_a, pull);
  const int steepest = way.steepest();
  int eighths = 4, axis = steepest;
  double away_on_axis = 0;
  if (way.stiff[steepest] > 0) {
    Row away, cost;
    way.consider(4, away, cost);
    double least = cost[steepest];
    if (const int other = way.best_eighths(steepest); other != 4) {
      Row away_there, cost_there;
      way.consider(other, away_there, cost_there);
      if (cost_there[steepest] < kOffMiddle * least) {
        eighths = other;
        least = cost_there[steepest] / kOffMiddle;
        away = away_there;
        cost = cost_there;
      }
    }
    const double share = kOffAxis * (eighths == 4 ? 1 : kOffMiddle);
    for (const int turn : {1, 2}) {
      const int turned = (steepest + turn) % 3;
      if (!(way.stiff[turned] > 0)) continue;
      if (cost[turned] < share * least) axis = turned, least = cost[turned] / share;
    }
    away_on_axis = away[axis];
  }
  // between_ends() of all axes: eighths are whole numbers of them, and rounded down.
  const double of_a = 8 - eighths, of_b = eighths;
  Row place =
      (Row{a.x, a.y, a.z, a.z} * of_a + Row{b.x, b.y, b.z, b.z} * of_b + 4) * 0.125 - 0.4375;
  round_all(place);
  Vec3d position{place[0], place[1], place[2]};
  position[axis] += away_on_axis;
  return {position, sum.at(position)};
}

}  // namespace crease::simplification
