#include "crease/stored_values.h"
#include "mesh/octahedral.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace crease {
namespace {

// To the bit: -0 is not 0.
bool is_same(const StoredValue& value, const float* numbers) {
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (std::bit_cast<std::uint32_t>(value[k]) != std::bit_cast<std::uint32_t>(numbers[k])) {
      return false;
    }
  }
  return true;
}

std::vector<float> random_directions(int bits, std::size_t count) {
  std::mt19937 random(static_cast<unsigned>(bits));
  std::normal_distribution<double> normal;
  const OctahedralCoding coding(bits);
  std::vector<float> numbers{0, 0, 1, -1, 0, 0, 0, 0, 0};
  while (numbers.size() < 3 * count) {
    const Vec3d d{normal(random), normal(random), normal(random)};
    const Vec3f n = coding.decode(coding.encode(d));
    numbers.insert(numbers.end(), {n.x, n.y, n.z});
  }
  return numbers;
}

TEST_CASE("directions of a lattice take four bytes and stay the same to the bit") {
  for (int bits = 8; bits <= 16; ++bits) {
    CAPTURE(bits);
    const std::vector<float> numbers = random_directions(bits, 500);
    StoredValues values(numbers, 3);
    CHECK(values.bytes() == 12 * values.size());
    values.pack_directions();
    REQUIRE(values.size() == 500);
    CHECK(values.bytes() == 4 * values.size());
    CHECK(values.is_finite());
    for (std::size_t i = 0; i < values.size(); ++i) {
      REQUIRE(is_same(values[i], &numbers[3 * i]));
      REQUIRE(values.direction(i) == Vec3f{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]});
    }
  }
}

// Of one octant, with x no more than y: the others differ in signs and in the order of components.
TEST_CASE("to multiply by one over the length gives the floats that a division gives") {
  constexpr int kMostWhole = 12;
  std::size_t different = 0;
  for (int bits = 8; bits <= 16; ++bits) {
    const OctahedralCoding coding(bits);
    const auto m = static_cast<std::int32_t>(coding.max_component() / 2);
    const std::int32_t step = bits <= kMostWhole ? 1 : 61;
    for (std::int32_t x = 0; 2 * x <= m; x += step) {
      for (std::int32_t y = x; x + y <= m; y += bits <= kMostWhole ? 1 : 7) {
        const Vec3d n{double(x), double(y), double(m - x - y)};
        const double size = std::sqrt(dot(n, n));
        const Vec3f divided{static_cast<float>(n.x / size), static_cast<float>(n.y / size),
                            static_cast<float>(n.z / size)};
        const Vec3f found =
            coding.decode({static_cast<std::uint32_t>(x + m), static_cast<std::uint32_t>(y + m)});
        different += found == divided ? 0 : 1;
      }
    }
  }
  CHECK(different == 0);
}

TEST_CASE("one value that is of no lattice, and all stay numbers") {
  const float odd[][3] = {{0.6f, 0.8f, 0},
                          {2, 0, 0},
                          {-0.0f, 0, 1},
                          {std::nanf(""), 0, 0},
                          {0, std::nextafter(1.0f, 0.0f), 0},
                          {INFINITY, 0, 0}};
  for (const auto& value : odd) {
    std::vector<float> numbers = random_directions(12, 20);
    numbers.insert(numbers.begin() + 30, value, value + 3);
    StoredValues values(numbers, 3);
    values.pack_directions();
    CHECK(values.bytes() == 12 * values.size());
    for (std::size_t i = 0; i < values.size(); ++i) CHECK(is_same(values[i], &numbers[3 * i]));
  }
}

TEST_CASE("values are chosen by number, packed or not") {
  const std::vector<float> numbers = random_directions(10, 8);
  StoredValues packed(numbers, 3);
  packed.pack_directions();
  const StoredValues pairs({1, 2, 3, 4, 5, 6}, 2);
  const std::vector<std::uint32_t> which{2, 0, 2};
  for (const StoredValues& all : {packed, StoredValues(numbers, 3), pairs}) {
    const StoredValues chosen = all.chosen(which);
    REQUIRE(chosen.size() == which.size());
    CHECK(chosen.bytes_per_value() == all.bytes_per_value());
    for (std::size_t i = 0; i < which.size(); ++i) {
      CHECK(is_same(chosen[i], all[which[i]].begin()));
    }
  }
}

}  // namespace
}  // namespace crease
