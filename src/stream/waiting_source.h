// An asynchronous source, of which nothing else is asked, as one that waits: for what lies over
// asynchronous sources alone, as limits and tests do.
#pragma once

#include "crease/async_source.h"
#include "crease/byte_source.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

namespace crease {

class WaitingSource : public ByteSource {
 public:
  // `stopped` is asked ten times a second; true ends a read with Interrupted.
  WaitingSource(AsyncSourcePtr source, std::function<bool()> stopped)
      : source_(std::move(source)), stopped_(std::move(stopped)) {}

  std::string name() const override { return source_->name(); }
  std::uint64_t size() const override { return source_->size().value_or(0); }
  std::uint64_t bytes_read() const override { return source_->statistics().bytes_transferred; }
  // Until the size is known.
  Status begin() const { return read_at(0, {}); }

 private:
  Status read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    const Ticket ticket = source_->request({offset, into.size()});
    for (;;) {
      source_->wait(kGlance);
      if (stopped_ && stopped_()) {
        source_->cancel(ticket);
        return fail(Error::Interrupted, "interrupted");
      }
      for (const AsyncAnswer& answer : source_->poll()) {
        if (answer.ticket != ticket) continue;
        if (!answer.bytes.ok()) return answer.bytes.failure();
        std::copy(answer.bytes->begin(), answer.bytes->end(), into.begin());
        return Done{};
      }
    }
  }

  static constexpr std::chrono::milliseconds kGlance{100};
  const AsyncSourcePtr source_;
  const std::function<bool()> stopped_;
};

}  // namespace crease
