#include "crease/compact_ranges.h"

#include <doctest/doctest.h>

#include <random>

namespace crease {
namespace {

TEST_CASE("compact ranges and sparse lists are plain arrays, for any share of ordinary keys") {
  std::mt19937_64 random(3);
  for (unsigned ordinary_of_8 : {0u, 4u, 7u, 8u}) {
    CompactRanges ranges(2);
    SparseLists<int> lists;
    std::vector<std::uint32_t> counts;
    std::vector<std::vector<int>> plain;
    for (int i = 0; i < 1000; ++i) {
      const bool ordinary = random() % 8 < ordinary_of_8;
      counts.push_back(ordinary ? 2 : static_cast<std::uint32_t>(random() % 6));
      plain.emplace_back(ordinary ? 0 : random() % 4, i);
      ranges.push_back(counts.back());
      lists.push_back(plain.back());
    }
    std::uint32_t begin = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      REQUIRE(ranges.begin(i) == begin);
      REQUIRE(ranges.count(i) == counts[i]);
      begin += counts[i];
      const std::span<const int> list = lists.of(i);
      REQUIRE(std::vector<int>(list.begin(), list.end()) == plain[i]);
    }
    CHECK(ranges.total() == begin);
  }
}

TEST_CASE("a thousand ordinary keys take 200 bytes") {
  CompactRanges ranges(2);
  for (int i = 0; i < 1000; ++i) ranges.push_back(2);
  CHECK(ranges.bytes() == 196);
}

}  // namespace
}  // namespace crease
