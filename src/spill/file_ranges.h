// Which ranges of a file are used: where the next array goes, and what can be thrown away.
//
//   FileRanges ranges;
//   std::uint64_t offset = ranges.take(65536);       // may be at the end: then ranges.end() grows
//   const Range stale = ranges.give_back(offset);    // often none
//   if (stale.size > 0) ...throw its contents away, then ranges.give_back_clean(stale.offset);
//
// Free neighbours become one. A freed range keeps its pages, since the next array likely gets them;
// only when kStale bytes have come together are they worth a call of the system.
// Not for several threads at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <map>
#include <new>
#include <set>
#include <utility>

namespace crease::spill {

// For what serves operator new, and must not call it.
template <typename T>
struct MallocAllocator {
  using value_type = T;
  MallocAllocator() = default;
  template <typename U>
  MallocAllocator(const MallocAllocator<U>&) {}
  T* allocate(std::size_t count) {
    void* memory = std::malloc(count * sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  friend bool operator==(const MallocAllocator&, const MallocAllocator&) { return true; }
};

struct Range {
  std::uint64_t offset = 0, size = 0;
};

class FileRanges {
 public:
  static constexpr std::uint64_t kPage = 4096;
  static constexpr std::uint64_t kStale = 4 << 20;

  // In the smallest free range that has room, else at the end. `size`: above 0; it is rounded up to
  // pages. Time O(log ranges).
  std::uint64_t take(std::uint64_t size);
  // Frees what take() gave. The range that is returned, unless its size is 0, is a larger one that
  // nobody gets until it was thrown away and given back as clean.
  Range give_back(std::uint64_t offset);
  void give_back_clean(std::uint64_t offset);

  std::uint64_t end() const { return end_; }    // all ranges are below
  std::uint64_t used() const { return used_; }  // bytes that were taken

 private:
  struct Piece {
    std::uint64_t size = 0;
    bool is_free = false;
    std::uint64_t stale = 0;  // of a free one: how much was used since it was thrown away
  };
  // By offset; they leave no gap.
  using Pieces = std::map<std::uint64_t, Piece, std::less<>,
                          MallocAllocator<std::pair<const std::uint64_t, Piece>>>;
  using SizeAndOffset = std::pair<std::uint64_t, std::uint64_t>;

  // Takes a piece and its free neighbours out; what they are together.
  std::pair<std::uint64_t, Piece> join_neighbours(Pieces::iterator piece, std::uint64_t stale);
  void add_free(std::uint64_t offset, const Piece& piece);
  void drop_free(Pieces::iterator piece);

  Pieces pieces_;
  std::set<SizeAndOffset, std::less<>, MallocAllocator<SizeAndOffset>> free_;
  std::uint64_t end_ = 0, used_ = 0;
};

}  // namespace crease::spill
