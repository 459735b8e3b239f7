#include "stream/request_board.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace crease::stream {

namespace {

std::uint64_t number(Ticket ticket) {
  return static_cast<std::uint64_t>(ticket);
}

// No range of a file ends beyond 2^64.
std::uint64_t end_of(const FileRange& range) {
  return range.offset +
         std::min(range.bytes, std::numeric_limits<std::uint64_t>::max() - range.offset);
}

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace

bool lies_within(const FileRange& range, std::uint64_t size) {
  return range.offset <= size && range.bytes <= size - range.offset;
}

Failure beyond_end(const FileRange& range, std::uint64_t size) {
  return fail(Error::Truncated, std::to_string(range.bytes) + " bytes at byte " +
                                    std::to_string(range.offset) + " are wanted of " +
                                    std::to_string(size));
}

RequestBoard::RequestBoard(std::string name, const AsyncOptions& options,
                           std::function<void()> wake)
    : name_(std::move(name)),
      options_(options),
      wake_(std::move(wake)),
      kept_(options.max_kept_bytes) {}

std::optional<std::uint64_t> RequestBoard::size() const {
  const std::lock_guard guard(lock_);
  return size_;
}

Ticket RequestBoard::add(std::span<const RangeRequest> ranges) {
  const auto first = static_cast<Ticket>(next_ticket_.fetch_add(ranges.size()));
  put({.kind = Order::Kind::Add,
       .ticket = first,
       .ranges = {ranges.begin(), ranges.end()},
       .at = Clock::now()});
  return first;
}

void RequestBoard::cancel(Ticket ticket) {
  put({.kind = Order::Kind::Cancel, .ticket = ticket});
}

void RequestBoard::prioritize(Ticket ticket, float priority) {
  put({.kind = Order::Kind::Prioritize, .ticket = ticket, .priority = priority});
}

void RequestBoard::give_back(std::uint64_t offset, std::vector<std::byte> bytes) {
  put({.kind = Order::Kind::GiveBack, .offset = offset, .bytes = std::move(bytes)});
}

// A worker that has the lock may have looked for orders before; so it is told that there are some.
void RequestBoard::put(Order order) {
  orders_.put(std::move(order));
  bool has_work = true;
  if (const std::unique_lock lock(lock_, std::try_to_lock); lock) has_work = carry_out_orders();
  if (!has_work) return;
  has_work_.ring();
  if (wake_) wake_();
}

bool RequestBoard::carry_out_orders() {
  bool any = false, has_work = false;
  orders_.read([&](const Order& order) {
    any = true;
    switch (order.kind) {
      case Order::Kind::Add:
        has_work |= add(order);
        break;
      case Order::Kind::Cancel:
        has_work |= cancel_now(order.ticket);
        break;
      case Order::Kind::Prioritize:
        prioritize_now(order.ticket, order.priority);
        break;
      case Order::Kind::GiveBack:
        keep(order.offset, order.bytes);
        break;
    }
  });
  return has_work || !any;
}

bool RequestBoard::add(const Order& order) {
  bool has_work = false;
  for (std::size_t i = 0; i < order.ranges.size(); ++i) {
    const Ticket ticket = ticket_after(order.ticket, i);
    const Waiting waiting{order.ranges[i].range, order.ranges[i].priority, order.at};
    ++statistics_.asked;
    statistics_.bytes_asked += waiting.range.bytes;
    if (answer_at_once(ticket, waiting)) continue;
    waiting_.emplace(Key{waiting.range.offset, ticket}, waiting);
    offset_of_waiting_.emplace(number(ticket), waiting.range.offset);
    has_work = true;
  }
  return has_work;
}

bool RequestBoard::cancel_now(Ticket ticket) {
  bool was_in_flight = false;
  if (const auto found = offset_of_waiting_.find(number(ticket));
      found != offset_of_waiting_.end()) {
    waiting_.erase(Key{found->second, ticket});
    offset_of_waiting_.erase(found);
    ++statistics_.cancelled;
  } else if (in_flight_.erase(number(ticket)) > 0) {
    ++statistics_.cancelled;
    was_in_flight = true;
  } else {
    std::erase_if(answers_, [ticket](const AsyncAnswer& a) { return a.ticket == ticket; });
  }
  if (waiting_.empty() && in_flight_.empty()) has_answer_.notify_all();
  return was_in_flight;
}

void RequestBoard::prioritize_now(Ticket ticket, float priority) {
  const auto found = offset_of_waiting_.find(number(ticket));
  if (found == offset_of_waiting_.end()) return;
  waiting_.find(Key{found->second, ticket})->second.priority = priority;
}

// Who has waited for answers may wait a little more for the lock.
std::vector<AsyncAnswer> RequestBoard::poll() {
  std::unique_lock lock(lock_, std::defer_lock);
  if (has_waited_.exchange(false)) {
    lock.lock();
  } else if (!lock.try_lock()) {
    return {};
  }
  carry_out_orders();
  return std::exchange(answers_, {});
}

bool RequestBoard::wait(std::chrono::milliseconds timeout) {
  std::unique_lock guard(lock_);
  carry_out_orders();
  has_answer_.wait_for(guard, timeout, [this] {
    return !answers_.empty() || (waiting_.empty() && in_flight_.empty());
  });
  if (!answers_.empty()) has_waited_ = true;
  return !answers_.empty();
}

AsyncStatistics RequestBoard::statistics() const {
  const std::lock_guard guard(lock_);
  AsyncStatistics told = statistics_;
  if (told.answered > 0) {
    told.latency_mean_seconds = latency_sum_seconds_ / static_cast<double>(told.answered);
  }
  return told;
}

void RequestBoard::set_size(std::uint64_t size) {
  const std::lock_guard guard(lock_);
  size_ = size;
  answer_what_can_be();
}

void RequestBoard::set_prefix(std::span<const std::byte> prefix) {
  const std::lock_guard guard(lock_);
  prefix_ = prefix;
  answer_what_can_be();
}

void RequestBoard::append_prefix(std::span<const std::byte> bytes, std::uint64_t expected) {
  const std::lock_guard guard(lock_);
  if (own_prefix_.capacity() < expected) own_prefix_.reserve(static_cast<std::size_t>(expected));
  own_prefix_.insert(own_prefix_.end(), bytes.begin(), bytes.end());
  prefix_ = own_prefix_;
  if (!waiting_.empty() && waiting_.begin()->first.first < prefix_.size()) answer_what_can_be();
}

std::uint64_t RequestBoard::prefix_bytes() const {
  const std::lock_guard guard(lock_);
  return prefix_.size();
}

bool RequestBoard::has_waiting() {
  const std::lock_guard guard(lock_);
  carry_out_orders();
  return !waiting_.empty();
}

bool RequestBoard::answer_at_once(Ticket ticket, const Waiting& waiting) {
  const FileRange& range = waiting.range;
  if (size_ && !lies_within(range, *size_)) {
    put_answer(ticket, waiting.asked_at, beyond_end(range, *size_));
    return true;
  }
  if (range.bytes == 0) {
    if (size_) put_answer(ticket, waiting.asked_at, std::vector<std::byte>());
    return size_.has_value();
  }
  if (size_ && end_of(range) <= prefix_.size()) {
    put_answer(ticket, waiting.asked_at,
               copy_of(prefix_.subspan(static_cast<std::size_t>(range.offset),
                                       static_cast<std::size_t>(range.bytes))));
    return true;
  }
  std::optional<std::vector<std::byte>> kept = kept_.take(range);
  if (kept) put_answer(ticket, waiting.asked_at, *std::move(kept));
  return kept.has_value();
}

void RequestBoard::answer_what_can_be() {
  for (auto i = waiting_.begin(); i != waiting_.end();) i = answer_if_can_be(i);
}

RequestBoard::Shelf::iterator RequestBoard::answer_if_can_be(Shelf::iterator waiting) {
  const Ticket ticket = waiting->first.second;
  if (!answer_at_once(ticket, waiting->second)) return std::next(waiting);
  offset_of_waiting_.erase(number(ticket));
  return waiting_.erase(waiting);
}

void RequestBoard::put_answer(Ticket ticket, Clock::time_point asked_at,
                              Result<std::vector<std::byte>> bytes) {
  const double seconds = std::chrono::duration<double>(Clock::now() - asked_at).count();
  ++statistics_.answered;
  latency_sum_seconds_ += seconds;
  statistics_.latency_max_seconds = std::max(statistics_.latency_max_seconds, seconds);
  if (!bytes.ok() && !name_.empty()) {
    bytes = crease::fail(bytes.failure().error, name_ + ": " + bytes.failure().message);
  }
  answers_.push_back({ticket, std::move(bytes)});
  has_answer_.notify_all();
}

RequestBoard::Shelf::const_iterator RequestBoard::most_urgent() const {
  return std::max_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
    if (a.second.priority != b.second.priority) return a.second.priority < b.second.priority;
    return a.first.second > b.first.second;  // the one asked for first
  });
}

std::optional<Batch> RequestBoard::take() {
  const std::lock_guard guard(lock_);
  carry_out_orders();
  return take_under_lock();
}

std::optional<Batch> RequestBoard::take_or_wait() {
  for (;;) {
    const std::uint32_t heard = has_work_.rings();
    {
      const std::lock_guard guard(lock_);
      if (closed_) return std::nullopt;
      carry_out_orders();
      if (!waiting_.empty()) return take_under_lock();
    }
    has_work_.wait(heard);
  }
}

std::optional<Batch> RequestBoard::take_under_lock() {
  if (waiting_.empty()) return std::nullopt;
  const auto seed = most_urgent();
  const float priority = seed->second.priority;
  Batch batch;
  batch.span = seed->second.range;
  auto after = std::next(seed);
  move_into(batch, seed);
  // Behind it first, since that is how files are read; then before it; both until neither fits.
  for (bool grew = true; grew;) {
    grew = false;
    while (after != waiting_.end()) {
      const auto candidate = after;
      ++after;
      if (!grow(batch, candidate, priority)) {
        after = candidate;
        break;
      }
      grew = true;
    }
    if (after != waiting_.begin() && grow(batch, std::prev(after), priority)) grew = true;
  }
  std::sort(batch.parts.begin(), batch.parts.end(), [](const BatchPart& a, const BatchPart& b) {
    return end_of(a.range) < end_of(b.range);
  });
  return batch;
}

// Takes `candidate` along if it lies near enough and the batch stays small enough.
bool RequestBoard::grow(Batch& batch, Shelf::const_iterator candidate, float priority) {
  const FileRange& range = candidate->second.range;
  const std::uint64_t begin = batch.span.offset, end = end_of(batch.span);
  const std::uint64_t gap = range.offset > end      ? range.offset - end
                            : end_of(range) < begin ? begin - end_of(range)
                                                    : 0;
  if (gap > options_.max_gap_bytes) return false;
  const std::uint64_t new_begin = std::min(begin, range.offset);
  const std::uint64_t bytes = std::max(end, end_of(range)) - new_begin;
  const bool is_as_urgent = candidate->second.priority == priority;
  const std::uint64_t limit = is_as_urgent
                                  ? std::max(options_.max_request_bytes, options_.min_request_bytes)
                                  : options_.min_request_bytes;
  if (bytes > std::max(limit, batch.span.bytes)) return false;
  batch.span = {new_begin, bytes};
  move_into(batch, candidate);
  return true;
}

void RequestBoard::move_into(Batch& batch, Shelf::const_iterator taken) {
  const Ticket ticket = taken->first.second;
  batch.parts.push_back({ticket, taken->second.range, taken->second.asked_at});
  in_flight_.insert(number(ticket));
  offset_of_waiting_.erase(number(ticket));
  waiting_.erase(taken);
}

void RequestBoard::close() {
  {
    const std::lock_guard guard(lock_);
    closed_ = true;
  }
  has_work_.ring();
}

bool RequestBoard::is_abandoned(const Batch& batch) {
  const std::lock_guard guard(lock_);
  carry_out_orders();
  return std::none_of(
      batch.parts.begin() + static_cast<std::ptrdiff_t>(batch.answered), batch.parts.end(),
      [this](const BatchPart& part) { return in_flight_.contains(number(part.ticket)); });
}

void RequestBoard::deliver(Batch& batch, std::span<const std::byte> bytes) {
  const auto between = [&](std::uint64_t begin, std::uint64_t end) {
    return bytes.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
  };
  for (; batch.answered < batch.parts.size(); ++batch.answered) {
    const BatchPart& part = batch.parts[batch.answered];
    const std::uint64_t begin = part.range.offset - batch.span.offset,
                        end = begin + part.range.bytes;
    if (end > bytes.size()) return;
    std::vector<std::byte> copy = copy_of(between(begin, end));
    const std::lock_guard guard(lock_);
    if (begin > batch.done) keep(batch.span.offset + batch.done, between(batch.done, begin));
    const std::uint64_t own = std::max(begin, batch.done);  // parts may overlap
    if (!answer_now(part, std::move(copy)) && own < end) {
      keep(batch.span.offset + own, between(own, end));
    }
    batch.done = std::max(batch.done, end);
  }
}

void RequestBoard::fail(Batch& batch, const Failure& failure) {
  for (; batch.answered < batch.parts.size(); ++batch.answered) {
    answer(batch.parts[batch.answered], failure);
  }
}

void RequestBoard::answer(const BatchPart& part, Result<std::vector<std::byte>> bytes) {
  const std::lock_guard guard(lock_);
  answer_now(part, std::move(bytes));
}

// False: it was cancelled.
bool RequestBoard::answer_now(const BatchPart& part, Result<std::vector<std::byte>> bytes) {
  if (in_flight_.erase(number(part.ticket)) == 0) return false;
  put_answer(part.ticket, part.asked_at, std::move(bytes));
  return true;
}

// Some of it may have been asked for since the batch was taken.
void RequestBoard::keep(std::uint64_t offset, std::span<const std::byte> bytes) {
  kept_.keep(offset, bytes);
  auto i = waiting_.lower_bound(Key{offset, Ticket{0}});
  while (i != waiting_.end() && i->first.first - offset < bytes.size()) i = answer_if_can_be(i);
}

bool RequestBoard::fail_waiting(const Failure& failure) {
  const std::lock_guard guard(lock_);
  carry_out_orders();
  const Shelf failed = std::exchange(waiting_, {});
  for (const auto& [key, waiting] : failed) put_answer(key.second, waiting.asked_at, failure);
  offset_of_waiting_.clear();
  return !failed.empty();
}

void RequestBoard::count_request() {
  const std::lock_guard guard(lock_);
  ++statistics_.requests;
}

void RequestBoard::count_retry() {
  const std::lock_guard guard(lock_);
  ++statistics_.retries;
}

void RequestBoard::count_transferred(std::uint64_t bytes) {
  const std::lock_guard guard(lock_);
  statistics_.bytes_transferred += bytes;
}

}  // namespace crease::stream
