// Which active vertex a wedge stands at. The active vertices' wedges are ranges, one after the
// other, so it is the vertex whose range begins last at or before the wedge.
//
//   WedgeMap map(wedge_count);
//   map.set(WedgeId{0}, 7);                 // from wedge 0 on: slot 7
//   map.set(second_wedge, 9);               // a split
//   map.slot_at(wedge);                     // 7 or 9
//
// Begins are bits, with a bit for each 64 of them that has any, and so on up: a look-up reads a
// word or two where the mesh is fine, one more for each 64 times as coarse. Beside walking down
// from a root it takes 1/10 of the time on a million triangles (bench/refine), and it needs neither
// the slots of nodes nor the leaves of wedges: 4.2 bytes a wedge, of which the 4 are not touched
// until they are used.
#pragma once

#include "base/assert.h"
#include "crease/mesh_hierarchy.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crease {

class WedgeMap {
 public:
  explicit WedgeMap(std::size_t wedge_count)
      : slot_of_begin_(new std::uint32_t[wedge_count]), wedge_count_(wedge_count) {
    for (std::size_t bits = wedge_count; level_count_ == 0 || bits > 1; ++level_count_) {
      bits = (bits + 63) / 64;
      levels_[level_count_].assign(bits, 0);
    }
  }

  // `slot` stands from `begin` on, until the next begin.
  void set(WedgeId begin, std::uint32_t slot) {
    std::size_t i = index_of(begin);
    slot_of_begin_[i] = slot;
    for (std::size_t l = 0; l < level_count_; ++l, i /= 64) {
      std::uint64_t& word = levels_[l][i / 64];
      const bool had_any = word != 0;
      word |= std::uint64_t(1) << (i % 64);
      if (had_any) return;
    }
  }

  // The slot before `begin` stands there as well.
  void clear(WedgeId begin) {
    std::size_t i = index_of(begin);
    for (std::size_t l = 0; l < level_count_; ++l, i /= 64) {
      std::uint64_t& word = levels_[l][i / 64];
      word &= ~(std::uint64_t(1) << (i % 64));
      if (word != 0) return;
    }
  }

  std::uint32_t slot_at(WedgeId wedge) const { return slot_from(begin_before(wedge)); }

  // The same in two steps: the last begin at or before the wedge; there is one. And what stands
  // from there on.
  WedgeId begin_before(WedgeId wedge) const {
    std::size_t i = index_of(wedge);
    std::size_t l = 0;
    std::uint64_t found = levels_[0][i / 64] & (~std::uint64_t(0) >> (63 - i % 64));
    while (found == 0) {  // none in this word: the last word before it that has one
      i /= 64;
      ++l;
      found = levels_[l][i / 64] & ((std::uint64_t(1) << (i % 64)) - 1);
    }
    i = (i & ~std::size_t(63)) | last_bit(found);
    while (l > 0) i = 64 * i + last_bit(levels_[--l][i]);
    return WedgeId{static_cast<std::uint32_t>(i)};
  }
  std::uint32_t slot_from(WedgeId begin) const { return slot_of_begin_[index_of(begin)]; }
  void prefetch(WedgeId wedge) const { __builtin_prefetch(&levels_[0][index_of(wedge) / 64]); }
  void prefetch_slot(WedgeId begin) const { __builtin_prefetch(&slot_of_begin_[index_of(begin)]); }

  std::size_t bytes() const {
    std::size_t sum = 4 * wedge_count_;
    for (const std::vector<std::uint64_t>& level : levels_) sum += 8 * level.size();
    return sum;
  }

 private:
  static std::size_t last_bit(std::uint64_t word) {
    return static_cast<std::size_t>(std::countl_zero(word)) ^ 63;  // one instruction
  }

  static constexpr std::size_t kMaxLevels = 6;  // of 32 bits
  std::vector<std::uint64_t> levels_[kMaxLevels];
  std::size_t level_count_ = 0;
  std::unique_ptr<std::uint32_t[]> slot_of_begin_;
  std::size_t wedge_count_;
};

}  // namespace crease
