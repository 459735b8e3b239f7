// Which elements of a buffer a renderer has to fetch again, over many switches of level.
//
// mark() while the level moves, then take() once: it hands out the marked elements in front of the
// active end and keeps the others until they become active. So an element that changed while its
// triangle was inactive is told when the triangle comes back, and a copy is never stale.
// Time of take(): O(marks since the last one, and a word per 4096 elements that are active).
#pragma once

#include "crease/draw_changes.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace crease {

class ChangeSet {
 public:
  void resize(std::size_t count) {
    words_.clear();
    marked_.clear();
    grow(count);
  }

  // Room for `count` elements; what is marked stays marked.
  void grow(std::size_t count) {
    if (words_.size() * 64 >= count) return;
    words_.resize((count + 63) / 64, 0);
    marked_.resize((words_.size() + 63) / 64, 0);
  }

  void mark(std::size_t i) {
    words_[i / 64] |= std::uint64_t(1) << (i % 64);
    marked_[i / 4096] |= std::uint64_t(1) << (i / 64 % 64);
  }

  // Calls `refresh(i)` for each marked i < active, ascending, and writes the ranges they make up.
  template <typename Refresh>
  void take(std::size_t active, std::vector<Range>& ranges, Refresh refresh) {
    ranges.clear();
    const std::size_t limit = std::min(marked_.size(), (active + 4095) / 4096);
    for (std::size_t m = 0; m < limit; ++m) {
      for (std::uint64_t marked = marked_[m]; marked != 0; marked &= marked - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(marked));
        take_word(64 * m + bit, active, ranges, refresh);
        if (words_[64 * m + bit] == 0) marked_[m] &= ~(std::uint64_t(1) << bit);
      }
    }
  }

 private:
  template <typename Refresh>
  void take_word(std::size_t w, std::size_t active, std::vector<Range>& ranges, Refresh& refresh) {
    const std::size_t first = 64 * w;
    std::uint64_t bits = words_[w];
    if (active < first + 64) {
      bits &= active <= first ? 0 : ~std::uint64_t(0) >> (64 - (active - first));
    }
    words_[w] &= ~bits;
    while (bits != 0) {
      const auto begin = static_cast<unsigned>(std::countr_zero(bits));
      const auto count = static_cast<unsigned>(std::countr_one(bits >> begin));
      bits &= bits + (std::uint64_t(1) << begin);  // the run is done
      const auto i = static_cast<std::uint32_t>(first + begin);
      for (std::uint32_t k = 0; k < count; ++k) refresh(std::size_t(i) + k);
      if (!ranges.empty() && ranges.back().first + ranges.back().count == i) {
        ranges.back().count += count;
      } else {
        ranges.push_back({i, count});
      }
    }
  }

  std::vector<std::uint64_t> words_;   // a bit an element
  std::vector<std::uint64_t> marked_;  // a bit a word that has any
};

}  // namespace crease
