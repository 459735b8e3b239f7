// The corners that stand at each active vertex, as arrays in one pool.
//
//   CornerList list;                      // one a vertex, 12 bytes
//   lists.push_back(list, {corner, wedge});
//   for (CornerAt& at : lists.of(list)) ...
//
// A corner comes with its wedge, so that a split reads one run of memory and no triangle to tell
// which corners go to v_u. Blocks of 8, 16, 32, ... corners; the freed ones are used again. 64 bytes
// a vertex for valences up to 8.
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
  std::uint32_t first = 0;  // block in the pool, in units of the smallest one
  std::uint32_t count = 0;
  std::uint32_t capacity_log = 0;  // 8 << capacity_log
};

class CornerLists {
 public:
  CornerList make(std::size_t count = 0) {
    CornerList list;
    list.capacity_log = log_for(count);
    list.first = take_block(list.capacity_log);
    return list;
  }
  void free(const CornerList& list) { free_[list.capacity_log].push_back(list.first); }

  std::span<CornerAt> of(const CornerList& list) {
    return {pool_.data() + std::size_t(list.first) * kUnit, list.count};
  }
  std::span<const CornerAt> of(const CornerList& list) const {
    return {pool_.data() + std::size_t(list.first) * kUnit, list.count};
  }

  void push_back(CornerList& list, const CornerAt& at) {
    reserve(list, list.count + 1);
    pool_[std::size_t(list.first) * kUnit + list.count++] = at;
  }
  void reserve(CornerList& list, std::size_t count) {
    if (count > capacity(list)) move_to(list, log_for(count));
  }
  // After corners were taken away: what is much too large is given back.
  void trim(CornerList& list) {
    if (list.capacity_log > 0 && list.count <= capacity(list) / 4) {
      move_to(list, log_for(2 * std::size_t(list.count)));
    }
  }
  // The order is of no consequence.
  void erase(CornerList& list, CornerRef corner) {
    const std::span<CornerAt> all = of(list);
    for (CornerAt& at : all) {
      if (!(at.corner == corner)) continue;
      at = all.back();
      --list.count;
      return;
    }
  }

  std::size_t bytes() const {
    std::size_t sum = sizeof(CornerAt) * pool_.capacity();
    for (const std::vector<std::uint32_t>& blocks : free_) sum += 4 * blocks.capacity();
    return sum;
  }

 private:
  static constexpr std::size_t kUnit = 8;

  static std::size_t capacity(const CornerList& list) { return kUnit << list.capacity_log; }
  static std::uint32_t log_for(std::size_t count) {
    return count <= kUnit ? 0 : static_cast<std::uint32_t>(std::bit_width((count - 1) / kUnit));
  }
  std::uint32_t take_block(std::uint32_t log) {
    if (!free_[log].empty()) {
      const std::uint32_t first = free_[log].back();
      free_[log].pop_back();
      return first;
    }
    const std::size_t first = pool_.size() / kUnit;
    pool_.resize(pool_.size() + (kUnit << log));
    return static_cast<std::uint32_t>(first);
  }
  void move_to(CornerList& list, std::uint32_t log) {
    const CornerList old = list;
    list.first = take_block(log);
    list.capacity_log = log;
    std::copy_n(pool_.begin() + static_cast<std::ptrdiff_t>(std::size_t(old.first) * kUnit),
                old.count,
                pool_.begin() + static_cast<std::ptrdiff_t>(std::size_t(list.first) * kUnit));
    free(old);
  }

  std::vector<CornerAt> pool_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // by capacity_log
};

}  // namespace crease
