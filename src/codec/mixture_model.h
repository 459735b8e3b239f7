// What is known of a mixture's components: how likely each is, and how far off. Both learn, within
// a block, from every place that was coded. Floats without fused products.
#pragma once

#include "codec/axis_mixture.h"
#include "codec/learning_rates.h"

#include <array>
#include <cstddef>

namespace crease::codec {

// What says how far off components are: logarithms of lengths nearby.
using Sizes = std::array<float, 4>;

// About the mean of the last 1 / rate.
struct MeanSizes {
  Sizes of{};
  bool has_any = false;

  void learn(const Sizes& sizes, float rate);
};

// How likely each component is: moves towards what was right.
struct ComponentWeights {
  PerComponent of{};
  int seen = 0;

  void learn(const PerComponent& right);
};

// How far off each component is, as a power of two: a number of its own, and slopes over the sizes
// that the first two components have in common, and the others.
struct ComponentScales {
  PerComponent of{};
  std::array<Sizes, 2> slope{};
  float slope_rate = 0, first_rate = 0;
  int seen = 0;

  PerComponent at(const Sizes& sizes) const;
  // `excess`: how much farther off a component was than it expected; see place_mixture.h.
  void learn(const PerComponent& right, const PerComponent& excess, const Sizes& sizes,
             const Sizes& mean);
};

// Odds of the components, made to sum up to one; false if there are none.
bool make_shares(PerComponent& odds);

}  // namespace crease::codec
