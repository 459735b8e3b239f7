// Which elements of a buffer a renderer has to fetch again, over many switches of level.
//
// mark() while the level moves, then take() once: it hands out the marked elements in front of the
// active end and keeps the others until they become active. So an element that changed while its
// triangle was inactive is told when the triangle comes back, and a copy is never stale.
// Time of take(): nothing if none is marked, else O(marks since the last one, and a word per 64
// elements that are active). A second level of bits took longer to mark than it saved to look.
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
    has_any_ = false;
    grow(count);
  }

  // Room for `count` elements; what is marked stays marked.
  void grow(std::size_t count) {
    if (words_.size() * 64 < count) words_.resize((count + 63) / 64, 0);
  }

  void mark(std::size_t i) {
    words_[i / 64] |= std::uint64_t(1) << (i % 64);
    has_any_ = true;
  }

  // Without a branch, where nobody can foretell whether.
  void mark_if(std::size_t i, bool marks) {
    words_[i / 64] |= std::uint64_t(marks) << (i % 64);
    has_any_ |= marks;
  }

  // Calls `refresh(i)` for each marked i < active, ascending, and writes the ranges they make up.
  template <typename Refresh>
  void take(std::size_t active, std::vector<Range>& ranges, Refresh refresh) {
    ranges.clear();
    if (!has_any_) return;
    const std::size_t limit = std::min(words_.size(), (active + 63) / 64);
    const std::uint64_t* const words = words_.data();
    for (std::size_t w = 0; w < limit; ++w) {
      while (w + 4 <= limit && (words[w] | words[w + 1] | words[w + 2] | words[w + 3]) == 0) w += 4;
      if (w < limit && words[w] != 0) take_word(w, active, ranges, refresh);
    }
    has_any_ = limit > 0 && words_[limit - 1] != 0;  // beyond the active end
    for (std::size_t w = limit; w < words_.size() && !has_any_; ++w) has_any_ = words_[w] != 0;
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
    // One by one: where a run ends nobody can foretell.
    for (std::uint64_t left = bits; left != 0; left &= left - 1) {
      refresh(first + static_cast<std::size_t>(std::countr_zero(left)));
    }
    while (bits != 0) {
      const auto begin = static_cast<unsigned>(std::countr_zero(bits));
      const auto count = static_cast<unsigned>(std::countr_one(bits >> begin));
      bits &= bits + (std::uint64_t(1) << begin);  // the run is done
      const auto i = static_cast<std::uint32_t>(first + begin);
      if (!ranges.empty() && ranges.back().first + ranges.back().count == i) {
        ranges.back().count += count;
      } else {
        ranges.push_back({i, count});
      }
    }
  }

  std::vector<std::uint64_t> words_;  // a bit an element
  bool has_any_ = false;
};

}  // namespace crease
