// The progress of one stage that several threads work on.
//
//   SharedProgress progress(options.progress, "compare", samples);
//   parallel_for(n, [&](std::size_t i) {
//     if (progress.stopped()) return;
//     work(i);
//     progress.advance(1);
//   });
//   if (progress.stopped()) return fail(Error::Interrupted, ...);
#pragma once

#include "crease/progress.h"

#include <atomic>
#include <cstddef>
#include <mutex>

namespace crease {

class SharedProgress {
 public:
  // `whole`: how much there is to do, of which `done` has been.
  SharedProgress(const ProgressCallback& callback, const char* stage, std::size_t whole,
                 std::size_t done = 0)
      : callback_(callback), stage_(stage), whole_(whole), done_(done) {}

  // From any thread: so much more is done. A thread that is telling already tells for this one;
  // a callback that has asked to stop is not called again.
  void advance(std::size_t more) {
    const std::size_t now = done_.fetch_add(more) + more;
    if (!callback_ || !telling_.try_lock()) return;
    if (!stopped_ && !callback_(stage_, double(now) / double(whole_))) stopped_ = true;
    telling_.unlock();
  }

  // The callback has asked the work to stop.
  bool stopped() const { return stopped_; }

 private:
  const ProgressCallback& callback_;
  const char* stage_;
  std::size_t whole_;
  std::atomic<std::size_t> done_;
  std::atomic<bool> stopped_{false};
  std::mutex telling_;
};

}  // namespace crease
