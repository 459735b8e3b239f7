// From threads that must never wait to one that reads at a time: without a lock.
//
//   Mailbox<Order> orders;
//   orders.put(order);                               // any thread
//   orders.read([&](Order& order) { ... });          // under a lock of the readers'
//
// Letters are freed by those that put more, or with the box: an allocator's lock is waited for
// where one thread frees what another allocates from.
#pragma once

#include <atomic>
#include <utility>

namespace crease {

template <typename Thing>
class Mailbox {
 public:
  Mailbox() = default;
  ~Mailbox() {
    free(letters_.load());
    free(read_.load());
  }
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  void put(Thing thing) {
    free(read_.exchange(nullptr, std::memory_order_acquire));
    auto* const letter = new Letter{std::move(thing), nullptr};
    push(letters_, letter, letter);
  }

  // All that are there, in the order in which they were put.
  template <typename Read>
  void read(const Read& read) {
    Letter* const last = letters_.exchange(nullptr, std::memory_order_acquire);
    if (last == nullptr) return;
    Letter* first = nullptr;
    for (Letter* letter = last; letter != nullptr;) {
      Letter* const before = std::exchange(letter->next, first);
      first = std::exchange(letter, before);
    }
    for (Letter* letter = first; letter != nullptr; letter = letter->next) read(letter->thing);
    push(read_, first, last);
  }

 private:
  struct Letter {
    Thing thing;
    Letter* next;
  };

  static void push(std::atomic<Letter*>& to, Letter* first, Letter* last) {
    last->next = to.load(std::memory_order_relaxed);
    while (!to.compare_exchange_weak(last->next, first, std::memory_order_release,
                                     std::memory_order_relaxed)) {
    }
  }
  static void free(Letter* letter) {
    while (letter != nullptr) delete std::exchange(letter, letter->next);
  }

  std::atomic<Letter*> letters_{nullptr}, read_{nullptr};  // the last one first; in any order
};

}  // namespace crease
