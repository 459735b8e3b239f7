// A file must not depend on how many floats a processor takes at once.
#include "codec/axis_mixture.h"
#include "codec/mixture_model.h"

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

bool are_same(const Part& a, const Part& b) {
  return a.index == b.index && a.begin == b.begin && a.end == b.end &&
         std::bit_cast<std::uint32_t>(a.inner) == std::bit_cast<std::uint32_t>(b.inner);
}

TEST_CASE("shares, sums and weights are the same to the bit by eights and by fours") {
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    AxisMixture mixture = some_mixture(random), by_fours = mixture;
    const auto start = static_cast<std::int32_t>(random() % 2000) - 1000;
    const std::int64_t width = std::int64_t(1) << (random() % 20);
    const std::int64_t low = (std::int64_t(random() % 64) - 32) * width;

    const LikelyComponents likely(mixture, start);
    const bool is_endless = random() % 3 == 0;
    const std::size_t count = is_endless ? 8 : 1 + random() % 8;
    const float below = is_endless ? -likely.all() : likely.at(low);
    const Parts parts{low, width, below, count, is_endless};
    for (std::uint32_t k = 0; k < count; ++k) {
      const Part part = likely.part(parts, {k, true});
      REQUIRE(are_same(part, likely.part_by_fours(parts, {k, true})));
      for (const std::uint32_t place : {part.begin, part.end - 1}) {
        REQUIRE(are_same(part, likely.part(parts, {place, false})));
        REQUIRE(are_same(part, likely.part_by_fours(parts, {place, false})));
      }
      REQUIRE(part.begin == (k > 0 ? likely.part(parts, {k - 1, true}).end : 0));
      // And one by one.
      const std::uint32_t inner = is_endless && k == 0 ? 1 : k;
      REQUIRE(part.inner == (inner == 0 ? below : likely.at(low + inner * width)));
    }
    REQUIRE(likely.part(parts, {static_cast<std::uint32_t>(count - 1), true}).end == kAllShares);

    weigh(mixture, start, low, width);
    weigh_by_fours(by_fours, start, low, width);
    REQUIRE(std::bit_cast<Bits>(mixture.weight) == std::bit_cast<Bits>(by_fours.weight));
  }
}

// Where the inverse of a sum is infinite, shares would be no numbers, and stay so in a model.
TEST_CASE("odds that are hardly above zero have no shares") {
  for (const float odds : {0.0f, 1e-44f, 1e-40f, 1e-39f}) {
    PerComponent some{odds, 0, 0, odds};
    CHECK_FALSE(make_shares(some));
    CHECK(some[0] == odds);
  }
  for (const float odds : {1e-37f, 1e-20f, 1.0f, 1e20f}) {
    PerComponent some{odds, 0, 0, odds};
    CHECK(make_shares(some));
    CHECK(some == PerComponent{0.5f, 0, 0, 0.5f});
  }
}

}  // namespace
}  // namespace crease::codec
