// How much memory a call takes: every operator new and delete of the program is counted, also those
// of libraries in it.
//
//   HeapWatch watch;
//   decode();
//   watch.most();      // bytes above what there was at the start
#pragma once

#include <cstddef>

namespace crease::bench {

// One at a time. Counting takes a few nanoseconds an allocation, only while there is one.
class HeapWatch {
 public:
  HeapWatch();
  ~HeapWatch();
  HeapWatch(const HeapWatch&) = delete;
  HeapWatch& operator=(const HeapWatch&) = delete;

  std::size_t most() const;  // bytes at once, so far
  std::size_t now() const;   // bytes that are still there
};

}  // namespace crease::bench
