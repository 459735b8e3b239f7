#include "cli/global_new.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace crease::cli {

namespace {

std::atomic<MemoryLimit*> limit_of_process{nullptr};
std::atomic<bool> is_over{false};

}  // namespace

void allocate_from(MemoryLimit& limit) {
  limit_of_process.store(&limit, std::memory_order_release);
}

void allocate_without_limit() {
  is_over = true;
}

MemoryLimit* memory_limit() {
  return limit_of_process.load(std::memory_order_acquire);
}

}  // namespace crease::cli

#ifndef CREASE_SANITIZED  // sanitizers have their own

namespace {

// `alignment` 0: malloc()'s.
void* allocate_or_null(std::size_t size, std::size_t alignment) {
  crease::MemoryLimit* limit = crease::cli::memory_limit();
  size = std::max<std::size_t>(size, 1);
  if (alignment == 0) {
    const bool is_limited = limit != nullptr && !crease::cli::is_over;
    return is_limited ? limit->allocate(size) : std::malloc(size);
  }
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* allocate(std::size_t size, std::size_t alignment = 0) {
  while (true) {
    if (void* memory = allocate_or_null(size, alignment)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void release(void* memory) noexcept {
  crease::MemoryLimit* limit = crease::cli::memory_limit();
  if (limit == nullptr) {
    std::free(memory);
  } else {
    limit->free(memory);
  }
}

}  // namespace

// The standard's other forms call these.
void* operator new(std::size_t size) {
  return allocate(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
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

#endif
