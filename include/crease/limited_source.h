// A source that asks for so many bytes a second at most: to leave a connection to others, or to see
// what streaming looks like over a slow one.
//
//   auto limit = std::make_shared<RateLimit>(250e3);                   // bytes a second
//   AsyncSourcePtr source = limited_source(open_async_http(url), limit);
//   ... limit->set(1e6);                                               // at any time
//
// Ranges wait here, the most urgent one first, until the limit lets them pass to the source
// beneath: a bucket that fills at the limit's rate holds what a quarter of a second brings. A range
// passes while there is something in it and takes its bytes out, more than there are if need be, so
// that one range may be of any size. What counts is the ranges that are asked for; gaps between
// them that are transferred along, retries, and the first 64 KiB that a host's source fetches by
// itself do not.
//
// Ranges pass in request(), poll() and wait(), no thread is started.
#pragma once

#include "crease/async_source.h"

#include <chrono>
#include <limits>
#include <memory>
#include <mutex>

namespace crease {

// One for any number of sources, which share it. Threads: every call from any.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  // Bytes a second; infinity, or what is not above 0: no limit.
  explicit RateLimit(double bytes_per_second = std::numeric_limits<double>::infinity());

  void set(double bytes_per_second);
  double bytes_per_second() const;  // infinity: no limit

  // Whether something may pass now. If so its bytes are taken out.
  bool take(std::uint64_t bytes, Clock::time_point now = Clock::now());
  // Until something may pass: 0 if it may now.
  Clock::duration pause(Clock::time_point now = Clock::now()) const;

 private:
  double level_at(Clock::time_point now) const;

  mutable std::mutex lock_;
  double rate_, level_ = 0;
  Clock::time_point filled_at_;
};

// Both not null. statistics(): those of `source`, and what waits here counts as asked; its latency
// leaves out the wait here.
AsyncSourcePtr limited_source(AsyncSourcePtr source, std::shared_ptr<RateLimit> limit);

}  // namespace crease
