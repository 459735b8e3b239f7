// The pairs that were looked at again, cheapest first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease::simplification {

// Costs only grow as quadrics do, so an entry whose ends have changed since is a lower bound: it is
// looked at again when it comes to the top, and not before.
struct Entry {
  std::uint64_t key;    // cost, then pair: costs are not negative, so their bits are in their order
  std::uint32_t held;   // in held_, or kNone
  std::uint32_t tries;  // so often it was held

  Entry() = default;
  Entry(float cost, std::uint32_t pair, std::uint32_t held_at, std::uint32_t tries_so_far)
      : key(std::uint64_t(std::bit_cast<std::uint32_t>(cost)) << 32 | pair),
        held(held_at),
        tries(tries_so_far) {}
  float cost() const { return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32)); }
  std::uint32_t pair() const { return static_cast<std::uint32_t>(key); }
};

// The moves of std::push_heap and std::pop_heap, of which the order of equal entries is a result,
// but which of two children goes up is no branch: nobody could foretell it.
class CostHeap {
 public:
  bool empty() const { return entries_.empty(); }
  void clear() { entries_.clear(); }
  const Entry& top() const { return entries_[0]; }

  void push(const Entry& entry) {
    entries_.push_back(entry);
    rise(entries_.size() - 1, entry);
  }

  void pop() {
    const Entry last = entries_.back();
    entries_.pop_back();
    const std::size_t count = entries_.size();
    if (count == 0) return;
    Entry* const e = entries_.data();
    std::size_t hole = 0, child = 2;
    for (; child < count; child = 2 * hole + 2) {
      child -= e[child].key > e[child - 1].key;
      e[hole] = e[child];
      hole = child;
    }
    if (child == count) {
      e[hole] = e[child - 1];
      hole = child - 1;
    }
    rise(hole, last);
  }

 private:
  void rise(std::size_t hole, const Entry& entry) {
    Entry* const e = entries_.data();
    while (hole > 0) {
      const std::size_t parent = (hole - 1) / 2;
      if (!(e[parent].key > entry.key)) break;
      e[hole] = e[parent];
      hole = parent;
    }
    e[hole] = entry;
  }

  std::vector<Entry> entries_;
};

}  // namespace crease::simplification
