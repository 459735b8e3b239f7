#include "mesh/own_grid.h"

#include "mesh/box_of.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace crease {

namespace {

// How exact numbers are.
struct Exactness {
  bool are_floats = true;
  double away = 0;  // the greatest, without its sign

  // What is left of a sum of numbers, as where a translation was added.
  double of_sum() const { return std::ldexp(away, are_floats ? -23 : -51); }
};

Exactness exactness_of(std::span<const Vec3d> positions) {
  Exactness result;
  for (const Vec3d& p : positions) {
    for (int i = 0; i < 3; ++i) {
      result.are_floats = result.are_floats && double(float(p[i])) == p[i];
      result.away = std::max(result.away, std::abs(p[i]));
    }
  }
  return result;
}

// A step as a quotient: doubles hold powers of ten, and not what these are the inverse of, so a
// multiple is rounded once.
struct RoundStep {
  double of = 1, divisor = 1;

  double length() const { return of / divisor; }
  double nearest(double x) const { return std::round(x / of * divisor) * of / divisor; }
};

std::vector<RoundStep> round_steps(double shortest, double longest) {
  constexpr int kDecimals = 15, kBinary = 50;
  std::vector<RoundStep> steps;
  const auto add = [&](const RoundStep& step) {
    if (step.length() >= shortest && step.length() <= longest) steps.push_back(step);
  };
  double power = 1;
  for (int k = 0; k <= kDecimals; ++k, power *= 10) {
    for (const double digit : {5.0, 2.0, 1.0}) {
      add({digit, power});
      if (k > 0) add({digit * power, 1});
    }
  }
  for (int k = -kBinary; k <= kBinary; ++k) add({1, std::ldexp(1.0, k)});
  std::sort(steps.begin(), steps.end(),
            [](const RoundStep& a, const RoundStep& b) { return a.length() > b.length(); });
  return steps;
}

// Numbers along an axis, each once.
std::vector<double> numbers_along(std::span<const Vec3d> positions, int axis) {
  std::vector<double> numbers;
  numbers.reserve(positions.size());
  for (const Vec3d& p : positions) numbers.push_back(p[axis]);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

// What numbers are whole steps apart by, if they are: the shortest gap is a step, and each longer
// one tells it more exactly. 0: they are not.
double step_of(const std::vector<double>& numbers, double off) {
  std::vector<double> gaps;
  for (std::size_t i = 1; i < numbers.size(); ++i) gaps.push_back(numbers[i] - numbers[i - 1]);
  std::sort(gaps.begin(), gaps.end());
  double length = 0, steps = 0;
  for (const double gap : gaps) {
    const double step = steps > 0 ? length / steps : gap, count = std::round(gap / step);
    if (!(step > 16 * off) || std::abs(gap - count * step) > 4 * off) return 0;
    length += gap;
    steps += count;
  }
  return steps > 0 ? length / steps : 0;
}

std::optional<Grid> regular_grid(std::span<const Vec3d> positions, double longest,
                                 double shortest) {
  constexpr std::size_t kFewest = 64;  // numbers that are no grid by chance
  const double off = exactness_of(positions).of_sum();
  const PointBox box = box_of(positions);
  int most = 0;
  for (int i = 1; i < 3; ++i) {
    if (box.size[i] > box.size[most]) most = i;
  }
  const std::vector<double> tell = numbers_along(positions, most);
  if (tell.size() < kFewest) return std::nullopt;
  const double step = step_of(tell, off);
  if (!(step >= shortest && step <= longest)) return std::nullopt;
  for (const Vec3d& p : positions) {
    for (int i = 0; i < 3; ++i) {
      const double away = p[i] - box.low[i];
      if (std::abs(away - std::round(away / step) * step) > 2 * off) return std::nullopt;
    }
  }
  return Grid{box.low, step};
}

}  // namespace

std::optional<double> round_step(std::span<const Vec3d> positions, double longest,
                                 double shortest) {
  const Exactness exactness = exactness_of(positions);
  const bool are_floats = exactness.are_floats;
  const double off = exactness.of_sum();
  const auto is_on = [&](const RoundStep& step, double x) {
    const double nearest = step.nearest(x);
    return are_floats ? float(nearest) == float(x) : std::abs(nearest - x) <= off;
  };
  const double least = are_floats ? shortest : std::max(shortest, 1024 * off);
  for (const RoundStep& step : round_steps(least, longest)) {
    const bool all = std::all_of(positions.begin(), positions.end(), [&](const Vec3d& p) {
      return is_on(step, p.x) && is_on(step, p.y) && is_on(step, p.z);
    });
    if (all) return step.length();
  }
  return std::nullopt;
}

std::optional<Grid> own_grid(std::span<const Vec3d> positions, double longest, double shortest) {
  if (positions.empty()) return std::nullopt;
  if (const auto step = round_step(positions, longest, shortest)) return Grid{{}, *step};
  return regular_grid(positions, longest, shortest);
}

}  // namespace crease
