#include "serve/slow_line.h"

#include <algorithm>

namespace crease::serve {

bool SlowLine::pass(std::size_t bytes) {
  std::unique_lock guard(lock_);
  const std::chrono::duration<double> takes(static_cast<double>(bytes) / bytes_per_second_);
  free_at_ = std::max(free_at_, Clock::now()) + std::chrono::duration_cast<Clock::duration>(takes);
  const Clock::time_point through_at = free_at_;
  return !cut_notice_.wait_until(guard, through_at, [this] { return is_cut_; });
}

bool SlowLine::pause(std::chrono::milliseconds time) {
  std::unique_lock guard(lock_);
  return !cut_notice_.wait_for(guard, time, [this] { return is_cut_; });
}

void SlowLine::cut() {
  {
    const std::lock_guard guard(lock_);
    is_cut_ = true;
  }
  cut_notice_.notify_all();
}

}  // namespace crease::serve
