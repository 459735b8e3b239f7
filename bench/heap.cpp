#include "heap.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

std::atomic<bool> watching{false};
std::atomic<std::int64_t> live{0}, peak{0};

void* counted(void* memory) {
  if (memory == nullptr) std::abort();  // a benchmark out of memory
  if (watching.load(std::memory_order_relaxed)) {
    const std::int64_t now = live += std::int64_t(malloc_usable_size(memory));
    std::int64_t most = peak.load();
    while (now > most && !peak.compare_exchange_weak(most, now)) {
    }
  }
  return memory;
}

void release(void* memory) {
  if (watching.load(std::memory_order_relaxed)) live -= std::int64_t(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

// The array and nothrow forms call these.
void* operator new(std::size_t size) {
  return counted(std::malloc(std::max<std::size_t>(size, 1)));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const std::size_t step = std::size_t(alignment);
  return counted(
      std::aligned_alloc(step, (std::max<std::size_t>(size, 1) + step - 1) / step * step));
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace crease::bench {

HeapWatch::HeapWatch() {
  live = peak = 0;
  watching = true;
}

HeapWatch::~HeapWatch() {
  watching = false;
}

std::size_t HeapWatch::most() const {
  return std::size_t(std::max<std::int64_t>(0, peak.load()));
}

std::size_t HeapWatch::now() const {
  return std::size_t(std::max<std::int64_t>(0, live.load()));
}

}  // namespace crease::bench
