#include "parallel/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

namespace crease::parallel {

namespace {

constexpr int kMostThreads = 1024;  // what no machine is short of, and none makes without end

}  // namespace

void run_ranges(std::size_t count, std::size_t grain, RangeTask task) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [task](const tbb::blocked_range<std::size_t>& range) {
                      task.run(task.context, range.begin(), range.end());
                    });
}

void run_both(Task a, Task b) {
  tbb::parallel_invoke([a] { a.run(a.context); }, [b] { b.run(b.context); });
}

void run_on(int threads, Task task) {
  if (threads <= 0) return task.run(task.context);
  constexpr auto kAllowed = tbb::global_control::max_allowed_parallelism;
  const auto wanted = static_cast<std::size_t>(std::min(threads, kMostThreads));
  std::optional<tbb::global_control> raise;
  if (tbb::global_control::active_value(kAllowed) < wanted) raise.emplace(kAllowed, wanted);
  // The program may have set a lower limit, which wins; a larger arena would print a warning.
  const std::size_t allowed = std::min(wanted, tbb::global_control::active_value(kAllowed));
  tbb::task_arena arena(static_cast<int>(allowed));
  arena.execute([task] { task.run(task.context); });
}

struct Slots::Data {
  tbb::enumerable_thread_specific<void*> slots{nullptr};
};

Slots::Slots() : data_(std::make_unique<Data>()) {}
Slots::~Slots() = default;

void*& Slots::local() {
  return data_->slots.local();
}

std::vector<void*> Slots::all() const {
  return {data_->slots.begin(), data_->slots.end()};
}

}  // namespace crease::parallel
