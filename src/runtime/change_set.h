// Which elements of a buffer a renderer has to fetch again, over many switches of level.
//
// mark() while the level moves, then take() once: it hands out the marked elements in front of the
// active end and keeps the others until they become active. So an element that changed while its
// triangle was inactive is told when the triangle comes back, and a copy is never stale.
// Time of take(): O(marks since the last one + elements that became active / 64).
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
    words_.assign((count + 63) / 64, 0);
    active_ = count;
  }

  // Room for `count` elements; what is marked stays marked.
  void grow(std::size_t count) {
    if (words_.size() * 64 < count) words_.resize((count + 63) / 64, 0);
  }

  void mark(std::size_t i) {
    std::uint64_t& word = words_[i / 64];
    if (word == 0) touched_.push_back(static_cast<std::uint32_t>(i / 64));
    word |= std::uint64_t(1) << (i % 64);
  }

  // Calls `refresh(i)` for each marked i < active, ascending, and writes the ranges they make up.
  template <typename Refresh>
  void take(std::size_t active, std::vector<Range>& ranges, Refresh refresh) {
    ranges.clear();
    // Words with marks from the last end on are not in touched_ any more.
    for (std::size_t w = active_ / 64; w < (std::max(active, active_ + 1) + 63) / 64; ++w) {
      if (w < words_.size() && words_[w] != 0) touched_.push_back(static_cast<std::uint32_t>(w));
    }
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    for (std::uint32_t w : touched_) {
      const std::size_t first = std::size_t(w) * 64;
      std::uint64_t bits = words_[w];
      if (active < first + 64)
        bits &= active <= first ? 0 : ~std::uint64_t(0) >> (64 - (active - first));
      words_[w] &= ~bits;
      for (; bits != 0; bits &= bits - 1) {
        const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(bits));
        refresh(i);
        if (!ranges.empty() && ranges.back().first + ranges.back().count == i) {
          ++ranges.back().count;
        } else {
          ranges.push_back({static_cast<std::uint32_t>(i), 1});
        }
      }
    }
    touched_.clear();
    active_ = active;
  }

 private:
  std::vector<std::uint64_t> words_;    // a bit an element
  std::vector<std::uint32_t> touched_;  // words with marks, since the last take()
  std::size_t active_ = 0;              // of the last take(): no bit in front of it is set
};

}  // namespace crease
