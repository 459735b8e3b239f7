// Bytes that are asked for now and handed out later, so that whoever asks never waits: of memory,
// of a file, of a host (http_source.h).
//
//   Result<AsyncSourcePtr> source = open_async_file("city.crease");
//   const RangeRequest wanted[] = {{{entry.offset, entry.bytes}, importance}, ...};
//   const Ticket first = (*source)->request(wanted);    // wanted[i] has ticket_after(first, i)
//   ... each frame:
//   for (AsyncAnswer& answer : (*source)->poll()) use(answer.ticket, answer.bytes);
//
// Ranges that wait are ordered by priority. The most urgent one goes first and takes along what
// waits near it, so that many small ranges become few requests (AsyncOptions). Answers come in any
// order, each ticket's exactly once, unless it was cancelled.
//
// Threads: every call from any thread. No call but wait() ever waits for bytes. request(),
// cancel(), prioritize() and a poll() that follows no wait() do not wait for other threads either;
// so poll() may have nothing yet of what has just arrived. The others take a lock under which
// nobody does more than move records and copy bytes that are in memory.
#pragma once

#include "crease/byte_source.h"
#include "crease/result.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crease {

enum class Ticket : std::uint64_t {};

constexpr Ticket ticket_after(Ticket first, std::size_t i) {
  return static_cast<Ticket>(static_cast<std::uint64_t>(first) + i);
}

struct RangeRequest {
  FileRange range;
  float priority = 0;  // the higher, the sooner; equal ones in the order of asking
};

struct AsyncAnswer {
  Ticket ticket{};
  // All of the range, or why not, with the source's name: Truncated where it reaches beyond the
  // end.
  Result<std::vector<std::byte>> bytes;
};

// How ranges become requests. A single range is never divided.
struct AsyncOptions {
  int max_in_flight = 4;  // requests at a time
  // Ranges with a gap of at most so many bytes between them share a request.
  std::uint64_t max_gap_bytes = 16 * 1024;
  // What lies between, what was cancelled under way and what is given back is kept for who asks for
  // it later: at most so many bytes, each given out once.
  std::uint64_t max_kept_bytes = 1024 * 1024;
  // A request takes neighbours of any priority along until it has so many bytes ...
  std::uint64_t min_request_bytes = 64 * 1024;
  // ... and neighbours of the same priority until it has so many.
  std::uint64_t max_request_bytes = 1024 * 1024;
};

// Since the source was made.
struct AsyncStatistics {
  std::uint64_t asked = 0;              // ranges
  std::uint64_t answered = 0;           // of those, failures among them
  std::uint64_t cancelled = 0;          // of those, before they were answered
  std::uint64_t bytes_asked = 0;        // of ranges
  std::uint64_t requests = 0;           // to the file or host; retries not among them
  std::uint64_t retries = 0;            //
  std::uint64_t bytes_transferred = 0;  // gaps and retries among it; of hosts, bodies alone
  // From request() until the answer could be polled.
  double latency_mean_seconds = 0, latency_max_seconds = 0;
};

class AsyncSource {
 public:
  AsyncSource() = default;
  AsyncSource(const AsyncSource&) = delete;
  AsyncSource& operator=(const AsyncSource&) = delete;
  // Ends what is in flight; waits for a read of a file, not for a host.
  virtual ~AsyncSource() = default;

  virtual std::string name() const = 0;  // for messages; may be empty
  // Of the whole file. Nothing until that is known: of a host, before the first answer.
  virtual std::optional<std::uint64_t> size() const = 0;

  // The ticket of ranges[0]; the others' follow. A range of no bytes is answered as soon as the
  // size is known, or with the reason why it will not be. Time O(log waiting) a range.
  virtual Ticket request(std::span<const RangeRequest> ranges) = 0;
  Ticket request(const FileRange& range, float priority = 0) {
    const RangeRequest one{range, priority};
    return request({&one, 1});
  }

  // Its answer will not be polled, even if it has arrived. No matter for one that was polled.
  virtual void cancel(Ticket ticket) = 0;
  // As if it had been asked for with this priority. No matter for one that no longer waits.
  virtual void prioritize(Ticket ticket, float priority) = 0;

  // An answer that nobody has looked at, for who asks for it again. It may be forgotten.
  virtual void give_back(std::uint64_t offset, std::vector<std::byte> bytes) = 0;

  // What has arrived since the last call.
  virtual std::vector<AsyncAnswer> poll() = 0;
  // Until poll() has something to give (true), nothing is outstanding, or the time is over.
  virtual bool wait(std::chrono::milliseconds timeout) = 0;

  virtual AsyncStatistics statistics() const = 0;
};

using AsyncSourcePtr = std::shared_ptr<AsyncSource>;

// Answers at once; poll() has it. The bytes must outlive the source.
AsyncSourcePtr async_memory_source(std::span<const std::byte> bytes, std::string name = {});

// Reads `source` on max_in_flight threads of its own.
AsyncSourcePtr async_source(ByteSourcePtr source, const AsyncOptions& options = {});

// The same for a file; opening looks at its name alone.
Result<AsyncSourcePtr> open_async_file(const std::filesystem::path& path,
                                       const AsyncOptions& options = {});

}  // namespace crease
