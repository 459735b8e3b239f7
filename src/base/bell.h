// Wakes threads that wait for work. Who rings never waits, as std::condition_variable's notifiers
// may.
//
//   for (;;) {
//     const std::uint32_t heard = bell.rings();
//     ... do what there is, or leave ...
//     bell.wait(heard);                           // until it was rung since rings()
//   }
#pragma once

#include <atomic>
#include <cstdint>

namespace crease {

class Bell {
 public:
  void ring() {
    rings_.fetch_add(1, std::memory_order_release);
    rings_.notify_all();
  }
  std::uint32_t rings() const { return rings_.load(std::memory_order_acquire); }
  void wait(std::uint32_t heard) const { rings_.wait(heard, std::memory_order_acquire); }

 private:
  std::atomic<std::uint32_t> rings_{0};
};

}  // namespace crease
