// The corners that stand at an active vertex.
//
//   CornerList list;                      // one a vertex
//   lists.push_back(list, {corner, wedge});
//   for (CornerAt& at : lists.of(list)) ...
//
// A corner comes with its wedge, so that a split reads one run of memory and no triangle to tell
// which corners go to v_u. Up to 11 stand in the list itself, beside what else a move needs of the
// vertex; more of them in a block of 16, 32, 64, ... corners in a pool that all lists share.
#pragma once

#include "crease/mesh_hierarchy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// A corner of an active triangle: where the triangle is, and which of its corners.
class CornerRef {
 public:
  CornerRef() = default;
  CornerRef(std::uint32_t part, std::uint32_t triangle, std::uint32_t corner)
      : bits_(part << 30 | triangle << 2 | corner) {}
  std::uint32_t part() const { return bits_ >> 30; }
  std::uint32_t triangle() const { return (bits_ & 0x3fffffffu) >> 2; }  // of its part
  std::uint32_t corner() const { return bits_ & 3; }
  std::uint32_t index() const { return 3 * triangle() + corner(); }  // in the part's arrays
  std::uint32_t triangle_key() const { return bits_ >> 2; }  // equal iff part and triangle are
  bool operator==(const CornerRef&) const = default;

 private:
  std::uint32_t bits_ = 0;
};

struct CornerAt {
  CornerRef corner;
  WedgeId wedge{};
};

struct CornerList {
  static constexpr std::uint32_t kOwn = 11;

  std::uint32_t count = 0;
  std::uint32_t block = kNone;  // in the pool, or kNone: in `own`
  std::array<CornerAt, kOwn> own;
};

class CornerLists {
 public:
  std::span<CornerAt> of(CornerList& list) {
    return {list.block == kNone ? list.own.data() : pool_.data() + std::size_t(list.block) * kUnit,
            list.count};
  }
  std::span<const CornerAt> of(const CornerList& list) const {
    return {list.block == kNone ? list.own.data() : pool_.data() + std::size_t(list.block) * kUnit,
            list.count};
  }

  // New ones at the end are to be written.
  void resize(CornerList& list, std::size_t count) {
    if (list.block != kNone || count > CornerList::kOwn) change_block(list, count);
    list.count = static_cast<std::uint32_t>(count);
  }
  void push_back(CornerList& list, const CornerAt& at) {
    if (list.block == kNone && list.count < CornerList::kOwn) {
      list.own[list.count++] = at;
      return;
    }
    resize(list, list.count + 1);
    of(list).back() = at;
  }
  // The order is of no consequence.
  void erase(CornerList& list, CornerRef corner) {
    const std::span<CornerAt> all = of(list);
    for (CornerAt& at : all) {
      if (!(at.corner == corner)) continue;
      at = all.back();
      if (list.block == kNone) {
        --list.count;
      } else {
        resize(list, list.count - 1);
      }
      return;
    }
  }
  void clear(CornerList& list) { resize(list, 0); }

  std::size_t bytes() const {
    std::size_t sum = sizeof(CornerAt) * pool_.capacity();
    for (const std::vector<std::uint32_t>& blocks : free_) sum += 4 * blocks.capacity();
    return sum;
  }

 private:
  static constexpr std::size_t kUnit = 8;
  static constexpr std::uint32_t kSmallest = 1;  // log: blocks of 16

  // Blocks are kUnit << log. A list keeps its block until a quarter of it would do, so that no move
  // to and fro copies it each time.
  static std::uint32_t log_for(std::size_t count) {
    const auto log = static_cast<std::uint32_t>(std::bit_width((count - 1) / kUnit));
    return std::max(kSmallest, log);
  }

  // `list.count` corners are there, `count` must have room.
  void change_block(CornerList& list, std::size_t count) {
    if (list.block == kNone) {
      const std::uint32_t block = take_block(log_for(count));
      std::copy_n(list.own.begin(), list.count, at(block));
      list.block = block;
      return;
    }
    const std::uint32_t log = log_of_block(list.block);
    const std::uint32_t kept = static_cast<std::uint32_t>(std::min<std::size_t>(list.count, count));
    if (count > (kUnit << log)) {
      const std::uint32_t block = take_block(log_for(count));
      std::copy_n(at(list.block), kept, at(block));
      free_[log].push_back(list.block);
      list.block = block;
    } else if (count <= CornerList::kOwn / 2) {
      std::copy_n(at(list.block), kept, list.own.begin());
      free_[log].push_back(list.block);
      list.block = kNone;
    }
  }
  std::vector<CornerAt>::iterator at(std::uint32_t block) {
    return pool_.begin() + static_cast<std::ptrdiff_t>(std::size_t(block) * kUnit);
  }
  std::uint32_t log_of_block(std::uint32_t block) const { return log_of_unit_[block]; }
  std::uint32_t take_block(std::uint32_t log) {
    if (!free_[log].empty()) {
      const std::uint32_t block = free_[log].back();
      free_[log].pop_back();
      return block;
    }
    const auto block = static_cast<std::uint32_t>(pool_.size() / kUnit);
    pool_.resize(pool_.size() + (kUnit << log));
    log_of_unit_.resize(pool_.size() / kUnit, static_cast<std::uint8_t>(log));
    return block;
  }

  std::vector<CornerAt> pool_;
  std::vector<std::uint8_t> log_of_unit_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // by log
};

}  // namespace crease
