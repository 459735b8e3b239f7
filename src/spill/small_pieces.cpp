#include "spill/small_pieces.h"

#include <new>

namespace crease::spill {

namespace {

constexpr std::size_t kHead = 16;  // the size, and what keeps the piece aligned
constexpr std::size_t kLargestPooled = 32 << 10;

}  // namespace

// The pools ask for blocks aligned to their size. A page's has to do: nobody needs more than kHead.
void* SmallPieces::Pages::do_allocate(std::size_t bytes, std::size_t) {
  void* memory = file_.allocate(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* SmallPieces::allocate(std::size_t bytes) noexcept {
  try {
    std::call_once(pools_once_, [this] {
      pools_.emplace(std::pmr::pool_options{.max_blocks_per_chunk = 0,
                                            .largest_required_pool_block = kLargestPooled},
                     &pages_);
    });
    // In whole heads: the pools' blocks lie one behind the other, and some are 24 bytes long.
    const std::size_t whole = (bytes + 2 * kHead - 1) / kHead * kHead;
    auto* head = static_cast<std::byte*>(pools_->allocate(whole, kHead));
    *reinterpret_cast<std::size_t*>(head) = whole;
    return head + kHead;
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void SmallPieces::free(void* piece) noexcept {
  std::byte* head = static_cast<std::byte*>(piece) - kHead;
  pools_->deallocate(head, *reinterpret_cast<std::size_t*>(head), kHead);
}

}  // namespace crease::spill
