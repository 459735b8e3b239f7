// A file must not depend on how many floats a processor takes at once.
#include "codec/axis_mixture.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>

namespace crease::codec {
namespace {

using Bits = std::array<std::uint32_t, 8>;

AxisMixture some_mixture(std::mt19937& random) {
  std::uniform_real_distribution<float> weight(0, 1), center(-3000, 3000), power(-12, 4);
  AxisMixture mixture;
  for (std::size_t k = 0; k < kComponents; ++k) {
    mixture.weight[k] = random() % 3 == 0 ? 0 : weight(random);
    mixture.center[k] = center(random);
    mixture.inverse_scale[k] = std::exp2(power(random));
  }
  return mixture;
}

TEST_CASE("sums and weights are the same to the bit by eights and by fours") {
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    AxisMixture mixture = some_mixture(random), by_fours = mixture;
    const auto start = static_cast<std::int32_t>(random() % 2000) - 1000;
    const std::int64_t width = std::int64_t(1) << (random() % 20);
    const std::int64_t low = (std::int64_t(random() % 64) - 32) * width;

    const LikelyComponents likely(mixture, start);
    std::array<float, 8> ends, ends_by_fours;
    likely.at_ends(low, width, ends);
    likely.at_ends_by_fours(low, width, ends_by_fours);
    REQUIRE(std::bit_cast<Bits>(ends) == std::bit_cast<Bits>(ends_by_fours));
    for (std::int64_t k = 0; k < 8; ++k) {  // and one by one
      REQUIRE(ends[std::size_t(k)] == likely.at(low + (k + 1) * width));
    }

    weigh(mixture, start, low, width);
    weigh_by_fours(by_fours, start, low, width);
    REQUIRE(std::bit_cast<Bits>(mixture.weight) == std::bit_cast<Bits>(by_fours.weight));
  }
}

}  // namespace
}  // namespace crease::codec
