// Loops and tasks over threads.
//
//   parallel_for(patches.count(), [&](std::size_t p) { simplify(patches.of(p)); });
//   parallel_ranges(samples, 512, [&](std::size_t begin, std::size_t end) { ... });
//   parallel_both([&] { divide(left); }, [&] { divide(right); });
//   parallel_sort(order, less);
//   Comparison result = run_on(options.threads, [&] { return compare(a, b); });
//   PerThread<std::vector<float>> scratch;  ... scratch.local() inside of a task
//
// TBB does the work, and parallel.cpp alone includes it: it is compiled without the thread
// sanitizer as libtbb.so is, and what the sanitizer then cannot see is told to it here, exactly:
// what happened before a call happens before its tasks, and the tasks happen before what follows
// the call. Nothing is told about tasks of one call among each other, so their races are found.
#pragma once

#include "base/sanitizer.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#if defined(CREASE_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace crease {

namespace parallel {

// One of these per call, on the caller's stack: the caller's side of fork and join.
template <typename Body>
class Fork {
 public:
  explicit Fork(const Body& body) : body_(body) { release(&forked_); }
  ~Fork() { acquire(&joined_); }
  Fork(const Fork&) = delete;
  Fork& operator=(const Fork&) = delete;

  // The tasks' side.
  template <typename... Arguments>
  void run(Arguments... arguments) const {
    acquire(&forked_);
    const AtEnd release_joined{&joined_};
    body_(arguments...);
  }

 private:
  struct AtEnd {
    const char* joined;
    ~AtEnd() { release(joined); }
  };

#if defined(CREASE_THREAD_SANITIZER)
  static void acquire(const char* point) {
    __tsan_acquire(const_cast<char*>(point));
  }
  static void release(const char* point) {
    __tsan_release(const_cast<char*>(point));
  }
#else
  static void acquire(const char*) {}
  static void release(const char*) {}
#endif

  const Body& body_;
  char forked_ = 0, joined_ = 0;  // their addresses name the two points in time
};

// A call without its type, for the other side of parallel.cpp.
struct Task {
  template <typename Body>
  explicit Task(const Fork<Body>& fork)
      : run([](const void* f) { static_cast<const Fork<Body>*>(f)->run(); }), context(&fork) {}

  void (*run)(const void* context);
  const void* context;
};

struct RangeTask {
  template <typename Body>
  explicit RangeTask(const Fork<Body>& fork)
      : run([](const void* f, std::size_t begin, std::size_t end) {
          static_cast<const Fork<Body>*>(f)->run(begin, end);
        }),
        context(&fork) {}

  void (*run)(const void* context, std::size_t begin, std::size_t end);
  const void* context;
};

void run_ranges(std::size_t count, std::size_t grain, RangeTask task);
void run_both(Task a, Task b);
void run_on(int threads, Task task);

// One pointer per thread, null at first.
class Slots {
 public:
  Slots();
  ~Slots();
  Slots(const Slots&) = delete;
  Slots& operator=(const Slots&) = delete;

  void*& local();
  std::vector<void*> all() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace parallel

// Calls body(begin, end) for ranges that make up 0 to `count`; about `grain` or more each.
template <typename Body>
void parallel_ranges(std::size_t count, std::size_t grain, const Body& body) {
  const parallel::Fork<Body> fork(body);
  parallel::run_ranges(count, grain, parallel::RangeTask(fork));
}

// Calls body(i) for i from 0 to `count`, each i worth a task of its own.
template <typename Body>
void parallel_for(std::size_t count, const Body& body) {
  parallel_ranges(count, 1, [&body](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

template <typename A, typename B>
void parallel_both(const A& a, const B& b) {
  const parallel::Fork<A> fork_a(a);
  const parallel::Fork<B> fork_b(b);
  parallel::run_both(parallel::Task(fork_a), parallel::Task(fork_b));
}

// As std::sort: elements that are equal come in any order. `depth` halvings are run in parallel.
template <typename T, typename Less>
void parallel_sort(T* begin, T* end, const Less& less, int depth = 4) {
  constexpr std::ptrdiff_t kSmall = 4096;
  if (depth == 0 || end - begin < kSmall) return std::sort(begin, end, less);
  T* const middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, less);
  parallel_both([&] { parallel_sort(begin, middle, less, depth - 1); },
                [&] { parallel_sort(middle, end, less, depth - 1); });
}
template <typename T, typename Less>
void parallel_sort(std::vector<T>& values, const Less& less) {
  parallel_sort(values.data(), values.data() + values.size(), less);
}

// Returns work(), whose loops and tasks run on `threads` threads; 0: as many as the machine has or
// as the program allows TBB. More than there are processors are possible, for tests.
template <typename Work>
auto run_on(int threads, const Work& work) {
  std::optional<std::invoke_result_t<const Work&>> result;
  const auto body = [&] { result.emplace(work()); };
  {
    const parallel::Fork<decltype(body)> fork(body);
    parallel::run_on(threads, parallel::Task(fork));
  }
  return std::move(*result);
}

// A T for every thread that asks, made when it first does. local() may be called by any thread; the
// rest happens when no task uses it any more.
template <typename T>
class PerThread {
 public:
  PerThread() = default;
  ~PerThread() {
    for (void* slot : slots_.all()) delete static_cast<T*>(slot);
  }

  T& local() {
    void*& slot = slots_.local();
    if (slot == nullptr) slot = new T();
    return *static_cast<T*>(slot);
  }

 private:
  parallel::Slots slots_;
};

}  // namespace crease
