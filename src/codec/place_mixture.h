// Where a vertex may be, as a mixture of distributions that each have a centre of their own, and
// the coding of where it is: one axis after the other, each by halving an interval with the odds
// that the mixture gives. Which component was right is never coded: what an axis tells of that
// changes the components' weights for the next.
//
// Every component has the distribution function 1/2 + z / 2 sqrt(1 + z^2) along each axis: long
// tails, and nothing that machines disagree on. Doubles without fused products, as in
// predict_position.h.
#pragma once

#include "codec/coded_numbers.h"
#include "codec/known_bit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crease::codec {

inline constexpr std::size_t kComponents = 8;
using PerComponent = std::array<double, kComponents>;

// One axis: what each component expects, and how far it may be off.
struct AxisMixture {
  PerComponent weight{}, center{}, inverse_scale{};
};

// The components that count: those of at least a thousandth of the weight, mostly two or three.
class LikelyComponents {
 public:
  explicit LikelyComponents(const AxisMixture& axis) {
    double sum = 0;
    for (const double weight : axis.weight) sum += weight;
    for (std::size_t k = 0; k < kComponents; ++k) {
      if (!(axis.weight[k] > sum * kLeastShare)) continue;
      of_[count_] = k;
      weight_[count_] = axis.weight[k];
      center_[count_] = axis.center[k];
      inverse_scale_[count_] = axis.inverse_scale[k];
      all_ += axis.weight[k];
      steepest_ = std::max(steepest_, axis.inverse_scale[k]);
      ++count_;
    }
  }

  double all() const { return all_; }  // the weight of these
  // Within so much of each other all places are about as likely: what telling them apart by odds
  // would save is not worth its time.
  double even_width() const { return kEvenWidth / steepest_; }

  // Each one's distribution function at x, from -1 to 1, and the weighed sum.
  double at(double x, PerComponent& each) const {
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double z = (x - center_[i]) * inverse_scale_[i];
      each[i] = z / std::sqrt(1 + z * z);
    }
    for (std::size_t i = 0; i < count_; ++i) sum += weight_[i] * each[i];
    return sum;
  }

  // The weights after the place was found between those two.
  PerComponent after(const PerComponent& low, const PerComponent& high) const {
    PerComponent weights{};
    for (std::size_t i = 0; i < count_; ++i) weights[of_[i]] = weight_[i] * (high[i] - low[i]);
    return weights;
  }

 private:
  static constexpr double kLeastShare = 1.0 / 1024;
  static constexpr double kEvenWidth = 0.25;  // of the smallest scale

  std::size_t count_ = 0;
  double all_ = 0, steepest_ = 0;
  std::array<std::size_t, kComponents> of_;
  PerComponent weight_, center_, inverse_scale_;
};

// `value` is coded relative to `start`, near which it is likely, about `size` away; differences go
// round at 2^32. The weights learn what the value says.
template <class Coder>
std::int32_t code_axis(Coder& coder, AxisMixture& mixture, std::int32_t start, double size,
                       std::int32_t value) {
  const std::int64_t away = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) -
                                                      static_cast<std::uint32_t>(start));
  const std::uint32_t whole = static_cast<std::uint32_t>(size > 0 ? std::min(size, 1e8) : 0);
  const int first = 2 + static_cast<int>(std::bit_width(whole));
  std::int64_t low = -(std::int64_t(1) << first), high = -low;
  const LikelyComponents likely(mixture);
  PerComponent each_low, each_high, each_middle;
  const auto at = [&](std::int64_t x, PerComponent& each) {
    return likely.at(static_cast<double>(x) + start - 0.5, each);
  };
  double below = at(low, each_low), above = at(high, each_high);
  const double all = likely.all();
  KnownBit is_inside(above - below, 2 * all);
  if (!coder.bit(is_inside, low <= away && away < high)) {
    KnownBit is_above(all - above, (all - above) + (below + all));
    const bool up = coder.bit(is_above, away >= high);
    // Away from the start interval after interval, each twice as long as the one before.
    for (int i = first;; ++i) {
      const std::int64_t near = std::int64_t(1) << i;
      if (up) {
        low = near, high = 2 * near;
        below = above, each_low = each_high;
        above = at(high, each_high);
      } else {
        low = -2 * near, high = -near;
        above = below, each_high = each_low;
        below = at(low, each_low);
      }
      if (i == 30) break;
      KnownBit is_here(above - below, up ? all - below : above + all);
      if (coder.bit(is_here, low <= away && away < high)) break;
    }
  }
  const double even_width = std::max(likely.even_width(), 1.0);
  while (static_cast<double>(high - low) > even_width) {
    const std::int64_t middle = (low + high) / 2;
    const double there = at(middle, each_middle);
    KnownBit is_upper(above - there, above - below);
    if (coder.bit(is_upper, away >= middle)) {
      low = middle, below = there, each_low = each_middle;
    } else {
      high = middle, above = there, each_high = each_middle;
    }
  }
  mixture.weight = likely.after(each_low, each_high);
  low += code_index(coder, static_cast<std::uint32_t>(high - low),
                    static_cast<std::uint32_t>(away - low));
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(start) +
                                   static_cast<std::uint32_t>(low));
}

// A place as a mixture: what each component expects on two axes and, less what the tangent plane
// rises over them, on the third, the one nearest to the normal.
// Afterwards the excesses say how much farther off each component was than it expected.
struct PlaceMixture {
  std::array<PerComponent, 3> center{};
  PerComponent weight{}, tangent{}, normal{};  // of being right; how far off then
  std::array<double, 3> direction{0, 0, 1};    // of the normal along the axes, of unit length
  PerComponent tangent_excess{}, normal_excess{};
};

// How far a step along the first two axes leads along the third in the tangent plane.
inline double rise(const std::array<double, 3>& normal, double first, double second) {
  return -(normal[0] * first + normal[1] * second) / normal[2];
}
inline std::int32_t rounded(double x) {
  constexpr double kLimit = 1 << 30;
  if (!(x > -kLimit)) x = -kLimit;  // or not a number
  return static_cast<std::int32_t>(std::floor(std::min(x, kLimit) + 0.5));
}

// How a distribution's scale should grow, at z^2: the slope of its logarithm by that of the scale.
inline double excess(double z2) {
  return 3 * z2 / (1 + z2) - 1;
}

// Leaves in `mixture.weight` how likely each component was right.
template <class Coder>
std::array<std::int32_t, 3> code_place(Coder& coder, PlaceMixture& mixture,
                                       const std::array<std::int32_t, 3>& place) {
  constexpr double kLeast = 0.2;  // of scales, beside which the grid is coarse
  const auto& [n0, n1, n2] = mixture.direction;
  const double across = std::sqrt(std::max(1 - n0 * n0, 0.0));
  AxisMixture axis;
  axis.weight = mixture.weight;
  axis.center = mixture.center[0];
  PerComponent scale;
  for (std::size_t k = 0; k < kComponents; ++k) {
    scale[k] = mixture.tangent[k] * across + kLeast;
    axis.inverse_scale[k] = 1 / scale[k];
  }
  std::array<std::int32_t, 3> result;
  result[0] = code_axis(coder, axis, rounded(axis.center[0]), scale[0], place[0]);

  // A step along the first axis leads some way along the second; one that is long for a component
  // makes it expect more there as well.
  const double along = n0 * n1 / (across * across), rest = std::abs(n2) / across;
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double off = result[0] - axis.center[k], z = off * axis.inverse_scale[k];
    mixture.tangent_excess[k] = excess(z * z) * (1 - kLeast * axis.inverse_scale[k]);
    scale[k] = mixture.tangent[k] * rest * std::sqrt(0.5 + 0.5 * z * z) + kLeast;
    axis.center[k] = mixture.center[1][k] - along * off;
    axis.inverse_scale[k] = 1 / scale[k];
  }
  result[1] = code_axis(coder, axis, rounded(axis.center[0]), scale[0], place[1]);

  for (std::size_t k = 0; k < kComponents; ++k) {
    const double z = (result[1] - axis.center[k]) * axis.inverse_scale[k];
    mixture.tangent_excess[k] += excess(z * z) * (1 - kLeast * axis.inverse_scale[k]);
  }
  axis.center = mixture.center[2];
  for (std::size_t k = 0; k < kComponents; ++k) {
    scale[k] = mixture.normal[k] / std::abs(n2) + kLeast;
    axis.inverse_scale[k] = 1 / scale[k];
  }
  const std::uint32_t plane =
      static_cast<std::uint32_t>(rounded(rise(mixture.direction, result[0], result[1])));
  const std::int32_t above =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(place[2]) - plane);
  const std::int32_t beside = code_axis(coder, axis, rounded(axis.center[0]), scale[0], above);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double z = (beside - axis.center[k]) * axis.inverse_scale[k];
    mixture.normal_excess[k] = excess(z * z) * (1 - kLeast * axis.inverse_scale[k]);
  }
  result[2] = static_cast<std::int32_t>(static_cast<std::uint32_t>(beside) + plane);
  mixture.weight = axis.weight;
  return result;
}

// Where along `axis` (of the mixture's three) a child is whose other two coordinates are known, as
// a number of steps: `offset` + `per_unit` * coordinate, rounded. Leaves in `mixture` what
// code_place() does, as far as that can be told.
template <class Coder>
std::int32_t code_steps(Coder& coder, PlaceMixture& mixture, std::size_t axis,
                        const std::array<std::int32_t, 3>& place, double offset, double per_unit,
                        std::int32_t steps) {
  constexpr double kLeast = 0.2, kLeastOfAxis = 0.1;
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  const auto& n = mixture.direction;
  double along = n[axis];
  if (std::abs(along) < kLeastOfAxis) along = along < 0 ? -kLeastOfAxis : kLeastOfAxis;
  const double plane = -(n[i] * place[i] + n[j] * place[j]) / along;
  AxisMixture of;
  of.weight = mixture.weight;
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double center = plane + mixture.center[2][k] * n[2] / along;
    of.center[k] = offset + per_unit * center;
    of.inverse_scale[k] = 1 / (std::abs(per_unit) * mixture.normal[k] / std::abs(along) + kLeast);
  }
  steps = code_axis(coder, of, rounded(of.center[0]), 1 / of.inverse_scale[0], steps);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double z = (steps - of.center[k]) * of.inverse_scale[k];
    mixture.tangent_excess[k] = 0;
    mixture.normal_excess[k] = excess(z * z) * (1 - kLeast * of.inverse_scale[k]);
  }
  mixture.weight = of.weight;
  return steps;
}

}  // namespace crease::codec
