#include "codec/mixture_model.h"

#include "base/wide.h"
#include "codec/deterministic_math.h"
#include "codec/eight_floats.h"

#include <algorithm>

namespace crease::codec {

namespace {

constexpr float kScaleRate = 0.15f;
constexpr int kFirstSteps = 8, kSeenAtMost = 1 << 20;
constexpr float kLeastScale = -12, kMostScale = 16, kMostSlope = 2;
constexpr float kLeastSum = 0x1p-126f;  // of which the inverse is a number

}  // namespace

bool make_shares(PerComponent& odds) {
  const float sum = sum_of(EightFloats(odds));
  if (!(sum >= kLeastSum)) return false;
  (EightFloats(odds) * (1 / sum)).store(odds);
  return true;
}

void MeanSizes::learn(const Sizes& sizes, float rate) {
  if (!has_any) of = sizes;
  has_any = true;
  for (std::size_t j = 0; j < sizes.size(); ++j) of[j] += rate * (sizes[j] - of[j]);
}

void ComponentWeights::learn(const PerComponent& right) {
  const float rate = 1.0f / static_cast<float>(std::min(seen++, 100) + 15);
  const EightFloats now(of);
  (now + rate * (EightFloats(right) - now)).store(of);
}

CREASE_WIDE PerComponent ComponentScales::at(const Sizes& sizes) const {
  std::array<float, 2> common{};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < sizes.size(); ++j) common[i] += slope[i][j] * sizes[j];
  }
  const auto [a, b] = common;
  PerComponent result;
  rough_exp2(EightFloats(of) + EightFloats(FourFloats{a, a, b, b}, FourFloats{b, b, b, b}))
      .store(result);
  return result;
}

CREASE_WIDE void ComponentScales::learn(const PerComponent& right, const PerComponent& excess,
                                        const Sizes& sizes, const Sizes& mean) {
  const float rate = kScaleRate + first_rate / (1 + static_cast<float>(seen) / kFirstSteps);
  seen = std::min(seen + 1, kSeenAtMost);
  PerComponent step;
  const EightFloats steps = EightFloats(right) * EightFloats(excess);
  steps.store(step);
  const EightFloats next_scale = EightFloats(of) + rate * steps;
  const std::array<float, 2> sum{step[0] + step[1],
                                 (step[2] + step[3]) + (step[4] + step[5]) + (step[6] + step[7])};
  // A slope turns about the mean of the sizes: what it moves there comes off the components.
  std::array<float, 2> moved;
  FourFloats size, middle;
  std::memcpy(&size, sizes.data(), sizeof size);
  std::memcpy(&middle, mean.data(), sizeof middle);
  const FourFloats most = FourFloats{} + kMostSlope;
  const FourFloats away = lesser(greater(size - middle, -most), most);
  for (std::size_t i = 0; i < 2; ++i) {
    FourFloats now;
    std::memcpy(&now, slope[i].data(), sizeof now);
    const FourFloats next = lesser(greater(now + slope_rate * sum[i] * away, -most), most);
    std::memcpy(slope[i].data(), &next, sizeof next);
    const FourFloats turned = (next - now) * middle;
    moved[i] = (turned[0] + turned[1]) + (turned[2] + turned[3]);
  }
  const auto [a, b] = moved;
  (lesser(greater(next_scale, kLeastScale), kMostScale) -
   EightFloats(FourFloats{a, a, b, b}, FourFloats{b, b, b, b}))
      .store(of);
}

}  // namespace crease::codec
