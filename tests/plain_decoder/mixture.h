// docs/format-block.md, "Mixtures".
#pragma once

#include "plain_decoder/bits.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace plain {

inline constexpr std::size_t kComponents = 8;
using PerComponent = std::array<float, kComponents>;
using Sizes = std::array<float, 4>;

struct Axis {
  PerComponent weight{}, centre{}, inverse_scale{};
};

// "axis(start, size)".
std::int32_t read_axis(RangeDecoder& in, Axis& axis, std::int32_t start, float size);

// Its step 4: a number is one of `width` from `low` on, from `start`.
void weigh(Axis& axis, std::int32_t start, std::int64_t low, std::int64_t width);

// "round(x)" and "excess(q)".
std::int32_t round_of(float x);
float excess(float q);

// "What mixtures learn": the rates, of versions from 10 on and of those before.
struct Rates {
  float place_slopes = 0, direction_slopes = 0, mean = 0, first = 0;
};
inline constexpr Rates kRates{0.004f, 0.001f, 0.04f, 1}, kRatesBefore10{0.015f, 0.015f, 0.02f, 0};

struct ComponentWeights {
  PerComponent of{};
  int n = 0;

  void learn(const PerComponent& shares);
};

struct MeanSizes {
  Sizes of{};
  float rate = 0;
  bool has_any = false;

  void learn(const Sizes& sizes);
};

struct ComponentScales {
  PerComponent logarithm{};
  std::array<Sizes, 2> slope{};
  float slope_rate = 0, first = 0;
  int n = 0;

  PerComponent at(const Sizes& sizes) const;
  void learn(const PerComponent& shares, const PerComponent& excesses, const Sizes& sizes,
             const Sizes& mean);
};

// Of the weights that the last axis left; false if there is nothing to learn from.
bool make_shares(PerComponent& weights);

}  // namespace plain
