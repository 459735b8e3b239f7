#include "hierarchy/between.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace crease {
namespace {

using Place = std::array<std::int32_t, 3>;

// As the head of between.h says.
Place place_of(const Place& a, const Place& b, const Between& between) {
  Place p;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sum = double(8 - between.eighths) * a[i] + double(between.eighths) * b[i] + 4;
    p[i] = static_cast<std::int32_t>(std::floor(sum / 8));
  }
  const auto along = static_cast<std::size_t>(between.axis);
  const std::int64_t step = between_step(a[(along + 1) % 3] - b[(along + 1) % 3],
                                         a[(along + 2) % 3] - b[(along + 2) % 3]);
  p[along] += static_cast<std::int32_t>(between.steps * step);
  return p;
}

Place from(const Place& place, const Place& origin) {
  return {place[0] - origin[0], place[1] - origin[1], place[2] - origin[2]};
}

struct Ends {
  Place a, b;
};
Ends random_ends(std::mt19937& random) {
  const auto size = std::int32_t(1) << random() % 20;
  std::uniform_int_distribution<std::int32_t> coordinate(-size, size);
  const auto place = [&] {
    return Place{coordinate(random), coordinate(random), coordinate(random)};
  };
  return {place(), place()};
}

TEST_CASE("what lies between two ends is found, and found again from what was found") {
  std::mt19937 random(1);
  for (int i = 0; i < 20'000; ++i) {
    const Ends ends = random_ends(random);
    const Between between{static_cast<int>(1 + random() % 7), static_cast<int>(random() % 3),
                          static_cast<std::int32_t>(random() % (2 * kMostSteps + 1)) - kMostSteps};
    const Place p = place_of(ends.a, ends.b, between);
    const std::optional<Between> found = find_between(from(ends.a, p), from(ends.b, p));
    REQUIRE(found);
    CHECK(place_of(ends.a, ends.b, *found) == p);
    CHECK(std::abs(found->steps) <= kMostSteps);
    // Ends change places.
    const Between other{8 - between.eighths, between.axis, between.steps};
    CHECK(place_of(ends.b, ends.a, other) == p);
  }
}

TEST_CASE("what does not lie between two ends is not found") {
  std::mt19937 random(2);
  int none = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Ends ends = random_ends(random);
    const Place p = random_ends(random).a;
    bool lies = false;
    for (int eighths = 1; eighths < 8; ++eighths) {
      for (int axis = 0; axis < 3; ++axis) {
        for (std::int32_t steps = -kMostSteps; steps <= kMostSteps; ++steps) {
          lies = lies || place_of(ends.a, ends.b, {eighths, axis, steps}) == p;
        }
      }
    }
    none += !lies;
    CHECK(find_between(from(ends.a, p), from(ends.b, p)).has_value() == lies);
  }
  CHECK(none > 1'000);
}

TEST_CASE("ends that are too far apart are left to be stored as they are") {
  const std::int32_t far = 1 << 30;
  CHECK_FALSE(find_between({far, 0, 0}, {-far, 0, 0}));
  CHECK(find_between({far / 2, 0, 0}, {-far / 2, 0, 0}));
}

TEST_CASE("the other end is one of a range, and the range is all of them") {
  for (int eighths = 1; eighths < 8; ++eighths) {
    for (std::int64_t b = -20; b <= 20; ++b) {
      for (std::int64_t p = -5; p <= 5; ++p) {
        const EndRange range = other_ends(b, p, eighths);
        CHECK(range.count >= 1);
        CHECK(range.count <= 8);
        for (std::int64_t a = -400; a <= 400; ++a) {
          const bool inside = a >= range.first && a < range.first + std::int64_t(range.count);
          REQUIRE((between_ends(a, b, eighths) == p) == inside);
        }
      }
    }
  }
}

}  // namespace
}  // namespace crease
