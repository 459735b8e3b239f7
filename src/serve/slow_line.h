// A line that lets so many bytes a second through, for all that use it together, and the pauses of
// one that is far away.
//
// Threads: any.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace crease::serve {

class SlowLine {
 public:
  explicit SlowLine(double bytes_per_second) : bytes_per_second_(bytes_per_second) {}

  // Returns when the bytes are through. False: the line was cut.
  bool pass(std::size_t bytes);
  bool pause(std::chrono::milliseconds time);
  // Whoever waits returns, now and from now on.
  void cut();

 private:
  using Clock = std::chrono::steady_clock;

  const double bytes_per_second_;
  std::mutex lock_;
  std::condition_variable cut_notice_;
  Clock::time_point free_at_ = Clock::now();
  bool is_cut_ = false;
};

}  // namespace crease::serve
