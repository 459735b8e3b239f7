// The corners that stand at an active vertex.
//
//   CornerList list;                      // one a vertex
//   lists.push_back(list, {corner, wedge});
//   for (const CornerAt at : lists.of(list)) ...
//
// A corner comes with its wedge, so that a split reads one run of memory and no triangle to tell
// which corners go to v_u. Up to 11 stand in the list itself, beside what else a move needs of the
// vertex; more of them in a block of 16, 32, 64, ... corners in a pool that all lists share.
//
// What is in a list is found by comparing all eleven, four at a time, without asking how many there
// are: how long a list is and where something stands in it nobody can foretell, and a processor
// that guesses wrong loses more than the whole comparison takes.
#pragma once

#include "base/four_floats.h"
#include "crease/mesh_hierarchy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
  std::uint32_t bits() const { return bits_; }
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
  std::uint32_t block = kNone;  // in the pool, or kNone: in the arrays here
  std::array<CornerRef, kOwn> refs;
  std::array<WedgeId, kOwn> wedges;

  bool is_own() const { return block == kNone; }
  CornerAt own(std::uint32_t i) const { return {refs[i], wedges[i]}; }
  // Of a list that is_own(): a bit for each corner that holds.
  std::uint32_t all() const { return (1u << count) - 1; }
  std::uint32_t same(CornerRef corner) const {
    const FourInts one = FourInts{} + static_cast<std::int32_t>(corner.bits());
    return all() & lanes(refs, [&](const FourInts& x) -> FourInts { return x == one; });
  }
  std::uint32_t of_triangle(CornerRef corner) const {
    const FourInts one = FourInts{} + static_cast<std::int32_t>(corner.bits());
    return all() &
           lanes(refs, [&](const FourInts& x) -> FourInts { return ((x ^ one) & ~3) == 0; });
  }
  std::uint32_t of_other_parts(std::uint32_t part) const {
    const auto bits = static_cast<std::int32_t>(CornerRef(part, 0, 0).bits());
    const FourInts one = FourInts{} + bits, high = FourInts{} + (std::int32_t(-1) << 30);
    return all() &
           lanes(refs, [&](const FourInts& x) -> FourInts { return ((x ^ one) & high) != 0; });
  }
  std::uint32_t from_wedge(WedgeId first) const {
    constexpr std::int32_t kSign = std::int32_t(1u << 31);  // compares as if there were none
    const FourInts least = FourInts{} + (static_cast<std::int32_t>(first) ^ kSign);
    return all() &
           lanes(wedges, [&](const FourInts& x) -> FourInts { return (x ^ kSign) >= least; });
  }
  void erase_own(std::uint32_t i) {  // the last one takes its place
    --count;
    refs[i] = refs[count];
    wedges[i] = wedges[count];
  }

 private:
  template <typename Id, typename Holds>
  static std::uint32_t lanes(const std::array<Id, kOwn>& ids, Holds holds) {
    static_assert(sizeof(ids) == 44);
    std::uint32_t bits = 0;
    for (const std::uint32_t first : {0u, 4u, kOwn - 4}) {
      FourInts four;
      std::memcpy(&four, ids.data() + first, sizeof(four));
      bits |= negative_lanes(holds(four)) << first;
    }
    return bits;
  }
};

class CornerLists {
 public:
  // What is in a list, until it changes.
  class View {
   public:
    View(const CornerRef* refs, const WedgeId* wedges, std::uint32_t count)
        : refs_(refs), wedges_(wedges), count_(count) {}
    std::uint32_t size() const { return count_; }
    CornerAt operator[](std::size_t i) const { return {refs_[i], wedges_[i]}; }
    View first(std::uint32_t count) const { return {refs_, wedges_, count}; }

    struct Iterator {
      const View* view;
      std::uint32_t i;
      CornerAt operator*() const { return (*view)[i]; }
      Iterator& operator++() {
        ++i;
        return *this;
      }
      bool operator!=(const Iterator& other) const { return i != other.i; }
    };
    Iterator begin() const { return {this, 0}; }
    Iterator end() const { return {this, count_}; }

   private:
    const CornerRef* refs_;
    const WedgeId* wedges_;
    std::uint32_t count_;
  };
  View of(const CornerList& list) const {
    if (list.is_own()) return {list.refs.data(), list.wedges.data(), list.count};
    return {&refs_[first(list)], &wedges_[first(list)], list.count};
  }

  void push_back(CornerList& list, CornerAt at) {
    if (list.is_own() && list.count < CornerList::kOwn) {
      list.refs[list.count] = at.corner;
      list.wedges[list.count++] = at.wedge;
      return;
    }
    push_back_further(list, at);
  }
  // The order is of no consequence.
  void erase(CornerList& list, CornerRef corner) {
    if (list.is_own()) {
      list.erase_own(static_cast<std::uint32_t>(std::countr_zero(list.same(corner))));
    } else {
      erase_further(list, corner);
    }
  }
  void replace(CornerList& list, CornerRef from, CornerRef to) {
    if (list.is_own()) {
      list.refs[static_cast<std::size_t>(std::countr_zero(list.same(from)))] = to;
    } else {
      refs_[first(list) + find(list, from)] = to;
    }
  }
  void clear(CornerList& list) { resize(list, 0); }

  // Takes out the corners of the wedges from `middle` on and calls visit(at) for each.
  template <typename Visit>
  void give(CornerList& list, WedgeId middle, Visit visit) {
    if (!list.is_own()) {
      keep_if(list, [&](const CornerAt& at) {
        if (at.wedge >= middle) visit(at);
        return at.wedge < middle;
      });
      return;
    }
    for (std::uint32_t leaving = list.from_wedge(middle); leaving != 0;) {
      const auto i = static_cast<std::uint32_t>(31 - std::countl_zero(leaving));
      leaving ^= 1u << i;
      const CornerAt at = list.own(i);
      list.erase_own(i);
      visit(at);
    }
  }
  // Takes out those for which keeps(at) is false.
  template <typename Keeps>
  void keep_if(CornerList& list, Keeps keeps) {
    std::uint32_t staying = 0;
    if (list.is_own()) {
      for (std::uint32_t i = 0; i < list.count; ++i) {
        const CornerAt at = list.own(i);
        const bool stays = keeps(at);
        list.refs[staying] = at.corner;
        list.wedges[staying] = at.wedge;
        staying += stays ? 1 : 0;
      }
      list.count = staying;
      return;
    }
    for (std::uint32_t i = 0; i < list.count; ++i) {
      const CornerAt at = of(list)[i];
      const bool stays = keeps(at);  // may move the pool
      refs_[first(list) + staying] = at.corner;
      wedges_[first(list) + staying] = at.wedge;
      staying += stays ? 1 : 0;
    }
    resize(list, staying);
  }

  std::size_t bytes() const {
    std::size_t sum = 8 * refs_.capacity() + log_of_unit_.capacity();
    for (const std::vector<std::uint32_t>& blocks : free_) sum += 4 * blocks.capacity();
    return sum;
  }

 private:
  static constexpr std::size_t kUnit = 8;
  static constexpr std::uint32_t kSmallest = 1;  // log: blocks of 16

  static std::size_t first(const CornerList& list) { return std::size_t(list.block) * kUnit; }
  std::uint32_t find(const CornerList& list, CornerRef corner) const {
    std::uint32_t i = 0;
    while (!(refs_[first(list) + i] == corner)) ++i;
    return i;
  }
  // Not inline, as such lists are rare: what is common keeps its registers.
  [[gnu::noinline]] void push_back_further(CornerList& list, CornerAt at) {
    resize(list, list.count + 1);
    refs_[first(list) + list.count - 1] = at.corner;
    wedges_[first(list) + list.count - 1] = at.wedge;
  }
  [[gnu::noinline]] void erase_further(CornerList& list, CornerRef corner) {
    const std::uint32_t i = find(list, corner);
    refs_[first(list) + i] = refs_[first(list) + list.count - 1];
    wedges_[first(list) + i] = wedges_[first(list) + list.count - 1];
    resize(list, list.count - 1);
  }
  // New ones at the end are to be written.
  void resize(CornerList& list, std::uint32_t count) {
    if (!list.is_own() || count > CornerList::kOwn) change_block(list, count);
    list.count = count;
  }
  // Blocks are kUnit << log. A list keeps its block until a quarter of it would do, so that no move
  // to and fro copies it each time.
  static std::uint32_t log_for(std::uint32_t count) {
    return std::max(kSmallest, static_cast<std::uint32_t>(std::bit_width((count - 1) / kUnit)));
  }
  // `list.count` corners are there, `count` must have room.
  [[gnu::noinline]] void change_block(CornerList& list, std::uint32_t count) {
    const bool was_own = list.is_own();
    const std::uint32_t log = was_own ? 0 : log_of_unit_[list.block];
    const std::uint32_t old = list.block;
    const std::uint32_t kept = std::min(list.count, count);
    if (was_own || count > (kUnit << log)) {
      list.block = take_block(log_for(count));
      const CornerRef* const refs = was_own ? list.refs.data() : &refs_[old * kUnit];
      const WedgeId* const wedges = was_own ? list.wedges.data() : &wedges_[old * kUnit];
      std::copy_n(refs, kept, &refs_[first(list)]);
      std::copy_n(wedges, kept, &wedges_[first(list)]);
      if (!was_own) free_[log].push_back(old);
    } else if (count <= CornerList::kOwn / 2) {
      std::copy_n(&refs_[first(list)], kept, list.refs.begin());
      std::copy_n(&wedges_[first(list)], kept, list.wedges.begin());
      free_[log].push_back(old);
      list.block = kNone;
    }
  }
  std::uint32_t take_block(std::uint32_t log) {
    if (!free_[log].empty()) {
      const std::uint32_t block = free_[log].back();
      free_[log].pop_back();
      return block;
    }
    const auto block = static_cast<std::uint32_t>(refs_.size() / kUnit);
    refs_.resize(refs_.size() + (kUnit << log));
    wedges_.resize(refs_.size());
    log_of_unit_.resize(refs_.size() / kUnit, static_cast<std::uint8_t>(log));
    return block;
  }

  std::vector<CornerRef> refs_;  // the pool
  std::vector<WedgeId> wedges_;
  std::vector<std::uint8_t> log_of_unit_;
  std::array<std::vector<std::uint32_t>, 32> free_;  // by log
};

}  // namespace crease
