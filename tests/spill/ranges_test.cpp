#include "spill/file_ranges.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <random>
#include <vector>

using namespace crease;
using spill::FileRanges;

namespace {

constexpr std::uint64_t kPage = FileRanges::kPage;

// Which pages are taken, page by page.
class TakenPages {
 public:
  void take(std::uint64_t offset, std::uint64_t size) {
    REQUIRE(offset % kPage == 0);
    for (std::uint64_t page = offset / kPage; page * kPage < offset + size; ++page) {
      if (page >= taken_.size()) taken_.resize(page + 1);
      REQUIRE(!taken_[page]);
      taken_[page] = true;
    }
  }
  void give_back(std::uint64_t offset, std::uint64_t size) {
    for (std::uint64_t page = offset / kPage; page * kPage < offset + size; ++page) {
      taken_[page] = false;
    }
  }
  bool any_in(const spill::Range& range) const {
    for (std::uint64_t page = range.offset / kPage; page * kPage < range.offset + range.size;
         ++page) {
      if (taken_[page]) return true;
    }
    return false;
  }

 private:
  std::vector<bool> taken_;
};

}  // namespace

TEST_CASE("ranges that are taken never overlap, and none of what is thrown away is taken") {
  std::mt19937 random(7);
  FileRanges ranges;
  TakenPages pages;
  std::map<std::uint64_t, std::uint64_t> size_of_offset;
  std::uint64_t used = 0, most_used = 0, thrown_away = 0;
  for (int step = 0; step < 20000; ++step) {
    // Grows and shrinks by turns, so that everything is free now and then.
    const bool takes = random() % 8 < (step / 500 % 2 == 0 ? 5u : 2u);
    if (takes || size_of_offset.empty()) {
      const std::uint64_t size = 1 + random() % (random() % 10 == 0 ? 4'000'000 : 60'000);
      const std::uint64_t offset = ranges.take(size);
      pages.take(offset, size);
      REQUIRE(offset + size <= ranges.end());
      size_of_offset[offset] = size;
      used += (size + kPage - 1) / kPage * kPage;
    } else {
      auto piece = size_of_offset.begin();
      std::advance(piece, random() % size_of_offset.size());
      used -= (piece->second + kPage - 1) / kPage * kPage;
      pages.give_back(piece->first, piece->second);
      const spill::Range stale = ranges.give_back(piece->first);
      size_of_offset.erase(piece);
      if (stale.size > 0) {
        CHECK(stale.size >= FileRanges::kStale);
        REQUIRE(!pages.any_in(stale));
        thrown_away += stale.size;
        pages.take(stale.offset, stale.size);  // nobody gets it meanwhile
        if (random() % 2 == 0) {
          const std::uint64_t offset = ranges.take(kPage);
          pages.take(offset, kPage);
          pages.give_back(offset, kPage);
          CHECK(ranges.give_back(offset).size == 0);
        }
        pages.give_back(stale.offset, stale.size);
        ranges.give_back_clean(stale.offset);
      }
    }
    most_used = std::max(most_used, used);
    REQUIRE(ranges.used() == used);
  }
  CHECK(thrown_away > 0);
  CHECK(ranges.end() < 2 * most_used);
}

TEST_CASE("free neighbours become one range, which serves the next") {
  FileRanges ranges;
  const std::uint64_t a = ranges.take(kPage), b = ranges.take(1), c = ranges.take(kPage + 1);
  CHECK(ranges.end() == 4 * kPage);
  ranges.give_back(a);
  ranges.give_back(c);
  ranges.give_back(b);
  CHECK(ranges.used() == 0);
  CHECK(ranges.take(4 * kPage) == a);
  CHECK(ranges.end() == 4 * kPage);
}

TEST_CASE("what was thrown away is thrown away again only after as much use") {
  FileRanges ranges;
  const std::uint64_t all = ranges.take(FileRanges::kStale);
  CHECK(ranges.give_back(all).size == FileRanges::kStale);
  ranges.give_back_clean(all);
  const std::uint64_t part = ranges.take(FileRanges::kStale / 2);
  CHECK(part == all);
  CHECK(ranges.give_back(part).size == 0);
  CHECK(ranges.give_back(ranges.take(FileRanges::kStale)).size == FileRanges::kStale);
}
