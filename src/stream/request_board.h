// What is asked of an asynchronous source, from the question to the answer: the asker's side puts
// ranges on the board and takes answers from it, workers take batches of ranges that lie near each
// other and bring their bytes.
//
//   RequestBoard board("city.crease", options);
//   board.add(ranges);                                 // the asker
//   while (std::optional<Batch> batch = board.take_or_wait()) {   // a worker
//     ... read batch->span ...
//     board.finish(*batch, bytes);
//   }
//   board.poll();                                      // the asker
//
// A ticket is in one of three places: waiting, in flight with a batch, or among the answers.
// Threads: every call from any; a batch belongs to the worker that took it.
//
// Askers never wait for workers, but in wait(): what they want is an order in a mailbox, which
// whoever has the lock next carries out, and where a worker has it just now, poll() has nothing. So
// a frame may hear a little later, but not stand still because a thread was stopped that had the
// lock.
#pragma once

#include "base/bell.h"
#include "base/mailbox.h"
#include "crease/async_source.h"
#include "stream/kept_bytes.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace crease::stream {

using Clock = std::chrono::steady_clock;

struct BatchPart {
  Ticket ticket{};
  FileRange range;
  Clock::time_point asked_at;
};

bool lies_within(const FileRange& range, std::uint64_t size);
Failure beyond_end(const FileRange& range, std::uint64_t size);  // Truncated

// Ranges that one request brings.
struct Batch {
  FileRange span;                // from the first byte to the last
  std::vector<BatchPart> parts;  // by where they end
  std::size_t answered = 0;      // of the parts, from the front
  std::uint64_t done = 0;        // bytes from the front that were answers, or are kept
};

class RequestBoard {
 public:
  // `wake` is called, outside of any lock, when there is work: ranges wait or a batch was
  // abandoned.
  RequestBoard(std::string name, const AsyncOptions& options, std::function<void()> wake = {});

  const AsyncOptions& options() const { return options_; }
  const std::string& name() const { return name_; }

  // The asker's side: see AsyncSource.
  std::optional<std::uint64_t> size() const;
  Ticket add(std::span<const RangeRequest> ranges);
  void cancel(Ticket ticket);
  void prioritize(Ticket ticket, float priority);
  void give_back(std::uint64_t offset, std::vector<std::byte> bytes);
  std::vector<AsyncAnswer> poll();
  bool wait(std::chrono::milliseconds timeout);
  AsyncStatistics statistics() const;  // without orders that nobody has carried out yet

  // The worker's side. Ranges beyond a known size fail without a request.
  void set_size(std::uint64_t size);
  // The first bytes of the file are at hand: ranges within them are answered without a request,
  // once the size is known. Either they lie elsewhere and stay there, or the board keeps a copy,
  // which grows; `expected` is what it will grow to, or 0.
  void set_prefix(std::span<const std::byte> prefix);
  void append_prefix(std::span<const std::byte> bytes, std::uint64_t expected);
  std::uint64_t prefix_bytes() const;
  bool has_waiting();

  // The most urgent range and what goes with it.
  std::optional<Batch> take();
  // The same, when there is something; nothing once the board is closed.
  std::optional<Batch> take_or_wait();
  void close();
  // All tickets of it were cancelled.
  bool is_abandoned(const Batch& batch);

  // `bytes` are the first ones of batch.span: parts that end within them are answered. What lies
  // between, and what is no longer wanted, is kept for who asks for it later.
  void deliver(Batch& batch, std::span<const std::byte> bytes);
  // The parts that are not answered yet.
  void fail(Batch& batch, const Failure& failure);
  // One part of a batch, in any order with other calls of this function alone.
  void answer(const BatchPart& part, Result<std::vector<std::byte>> bytes);
  // Everything that waits; whether anything did.
  bool fail_waiting(const Failure& failure);

  void count_request();
  void count_retry();
  void count_transferred(std::uint64_t bytes);

 private:
  struct Waiting {
    FileRange range;
    float priority = 0;
    Clock::time_point asked_at;
  };
  using Key = std::pair<std::uint64_t, Ticket>;  // offset
  using Shelf = std::map<Key, Waiting>;
  struct Order {
    enum class Kind { Add, Cancel, Prioritize, GiveBack } kind = Kind::Add;
    Ticket ticket{};                     // of the first range
    std::vector<RangeRequest> ranges{};  // Add
    float priority = 0;                  // Prioritize
    Clock::time_point at{};
    std::uint64_t offset = 0;        // GiveBack
    std::vector<std::byte> bytes{};  // GiveBack
  };

  void put(Order order);

  // Under the lock. True if there is something to do for workers.
  bool add(const Order& order);
  bool cancel_now(Ticket ticket);
  void prioritize_now(Ticket ticket, float priority);
  // The same of all orders, or true if there are none: others have carried them out.
  bool carry_out_orders();
  bool answer_at_once(Ticket ticket, const Waiting& waiting);
  void answer_what_can_be();
  Shelf::iterator answer_if_can_be(Shelf::iterator waiting);  // the next one
  bool answer_now(const BatchPart& part, Result<std::vector<std::byte>> bytes);
  void keep(std::uint64_t offset, std::span<const std::byte> bytes);
  void put_answer(Ticket ticket, Clock::time_point asked_at, Result<std::vector<std::byte>> bytes);
  Shelf::const_iterator most_urgent() const;
  std::optional<Batch> take_under_lock();
  bool grow(Batch& batch, Shelf::const_iterator candidate, float priority);
  void move_into(Batch& batch, Shelf::const_iterator taken);

  const std::string name_;
  const AsyncOptions options_;
  const std::function<void()> wake_;

  mutable std::mutex lock_;
  std::condition_variable has_answer_;
  Bell has_work_;
  std::optional<std::uint64_t> size_;
  std::span<const std::byte> prefix_;
  std::vector<std::byte> own_prefix_;  // where prefix_ lies, if it was appended
  KeptBytes kept_;
  std::atomic<std::uint64_t> next_ticket_{1};
  Mailbox<Order> orders_;
  std::atomic<bool> has_waited_{false};  // since the last poll(), until there were answers
  Shelf waiting_;
  std::unordered_map<std::uint64_t, std::uint64_t> offset_of_waiting_;  // by ticket
  std::unordered_set<std::uint64_t> in_flight_;                         // tickets not cancelled
  std::vector<AsyncAnswer> answers_;
  AsyncStatistics statistics_;
  double latency_sum_seconds_ = 0;
  bool closed_ = false;
};

// An AsyncSource whose askers' side is a board.
class BoardSource : public AsyncSource {
 public:
  explicit BoardSource(std::string name, const AsyncOptions& options,
                       std::function<void()> wake = {})
      : board_(std::move(name), options, std::move(wake)) {}

  std::string name() const override { return board_.name(); }
  std::optional<std::uint64_t> size() const override { return board_.size(); }
  Ticket request(std::span<const RangeRequest> ranges) override { return board_.add(ranges); }
  void cancel(Ticket ticket) override { board_.cancel(ticket); }
  void prioritize(Ticket ticket, float priority) override { board_.prioritize(ticket, priority); }
  void give_back(std::uint64_t offset, std::vector<std::byte> bytes) override {
    board_.give_back(offset, std::move(bytes));
  }
  std::vector<AsyncAnswer> poll() override { return board_.poll(); }
  bool wait(std::chrono::milliseconds timeout) override { return board_.wait(timeout); }
  AsyncStatistics statistics() const override { return board_.statistics(); }

 protected:
  RequestBoard board_;
};

}  // namespace crease::stream
