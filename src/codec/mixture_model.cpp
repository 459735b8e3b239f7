#include "codec/mixture_model.h"

#include "codec/deterministic_math.h"

#include <algorithm>

namespace crease::codec {

namespace {

constexpr double kScaleRate = 0.15, kSlopeRate = 0.015, kMeanRate = 0.02;
constexpr double kLeastScale = -12, kMostScale = 16, kMostSlope = 2;

}  // namespace

bool make_shares(PerComponent& odds) {
  double sum = 0;
  for (const double x : odds) sum += x;
  if (!(sum > 0)) return false;
  for (double& x : odds) x /= sum;
  return true;
}

void MeanSizes::learn(const Sizes& sizes) {
  if (!has_any) of = sizes;
  has_any = true;
  for (std::size_t j = 0; j < sizes.size(); ++j) of[j] += kMeanRate * (sizes[j] - of[j]);
}

void ComponentWeights::learn(const PerComponent& right) {
  const double rate = 1.0 / (std::min(seen++, 100) + 15);
  for (std::size_t k = 0; k < kComponents; ++k) of[k] += rate * (right[k] - of[k]);
}

PerComponent ComponentScales::at(const Sizes& sizes) const {
  std::array<double, 2> common{};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < sizes.size(); ++j) common[i] += slope[i][j] * sizes[j];
  }
  PerComponent result;
  for (std::size_t k = 0; k < kComponents; ++k) result[k] = rough_exp2(of[k] + common[k > 1]);
  return result;
}

void ComponentScales::learn(const PerComponent& right, const PerComponent& excess,
                            const Sizes& sizes, const Sizes& mean) {
  std::array<double, 2> sum{};
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double step = right[k] * excess[k];
    of[k] = std::clamp(of[k] + kScaleRate * step, kLeastScale, kMostScale);
    sum[k > 1] += step;
  }
  // A slope turns about the mean of the sizes: what it moves there comes off the components.
  for (std::size_t i = 0; i < 2; ++i) {
    double moved = 0;
    for (std::size_t j = 0; j < sizes.size(); ++j) {
      const double step = kSlopeRate * sum[i] * std::clamp(sizes[j] - mean[j], -2.0, 2.0);
      const double next = std::clamp(slope[i][j] + step, -kMostSlope, kMostSlope);
      moved += (next - slope[i][j]) * mean[j];
      slope[i][j] = next;
    }
    for (std::size_t k = 2 * i; k < (i == 0 ? 2 : kComponents); ++k) of[k] -= moved;
  }
}

}  // namespace crease::codec
