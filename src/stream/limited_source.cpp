#include "crease/limited_source.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

namespace crease {

namespace {

constexpr double kBucketSeconds = 0.25;
constexpr double kSmallestBucket = 1;  // bytes

double bucket_of(double rate) {
  return std::max(kSmallestBucket, rate * kBucketSeconds);
}

double sound(double rate) {
  return rate > 0 ? rate : std::numeric_limits<double>::infinity();
}

}  // namespace

RateLimit::RateLimit(double bytes_per_second)
    : rate_(sound(bytes_per_second)), filled_at_(Clock::now()) {
  level_ = bucket_of(rate_);
}

void RateLimit::set(double bytes_per_second) {
  const std::lock_guard guard(lock_);
  const Clock::time_point now = Clock::now();
  const bool was_limited = std::isfinite(rate_);
  const double level = was_limited ? level_at(now) : 0;
  rate_ = sound(bytes_per_second);
  level_ = std::isfinite(rate_) ? std::min(level, bucket_of(rate_)) : 0;
  filled_at_ = now;
}

double RateLimit::bytes_per_second() const {
  const std::lock_guard guard(lock_);
  return rate_;
}

double RateLimit::level_at(Clock::time_point now) const {
  const double seconds = std::chrono::duration<double>(now - filled_at_).count();
  return std::min(bucket_of(rate_), level_ + rate_ * std::max(0.0, seconds));
}

bool RateLimit::take(std::uint64_t bytes, Clock::time_point now) {
  const std::lock_guard guard(lock_);
  if (!std::isfinite(rate_)) return true;
  level_ = level_at(now);
  filled_at_ = std::max(filled_at_, now);
  if (level_ < kSmallestBucket) return false;
  level_ -= static_cast<double>(bytes);
  return true;
}

RateLimit::Clock::duration RateLimit::pause(Clock::time_point now) const {
  const std::lock_guard guard(lock_);
  if (!std::isfinite(rate_)) return {};
  const double lacking = kSmallestBucket - level_at(now);
  if (lacking <= 0) return {};
  const double seconds = std::min(lacking / rate_, 3600.0);
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)) +
         std::chrono::milliseconds(1);
}

namespace {

class LimitedSource final : public AsyncSource {
 public:
  LimitedSource(AsyncSourcePtr source, std::shared_ptr<RateLimit> limit)
      : source_(std::move(source)), limit_(std::move(limit)) {}

  std::string name() const override { return source_->name(); }
  std::optional<std::uint64_t> size() const override { return source_->size(); }

  Ticket request(std::span<const RangeRequest> ranges) override {
    const std::lock_guard guard(lock_);
    const auto first = static_cast<Ticket>(next_ticket_);
    for (const RangeRequest& range : ranges) waiting_.emplace(next_ticket_++, range);
    pass();
    return first;
  }

  void cancel(Ticket ticket) override {
    const std::lock_guard guard(lock_);
    const auto number = static_cast<std::uint64_t>(ticket);
    if (const auto at = waiting_.find(number); at != waiting_.end()) {
      ++cancelled_.cancelled;
      ++cancelled_.asked;
      cancelled_.bytes_asked += at->second.range.bytes;
      waiting_.erase(at);
      return;
    }
    std::erase_if(answers_, [ticket](const AsyncAnswer& a) { return a.ticket == ticket; });
    const auto at = inner_of_.find(number);
    if (at == inner_of_.end()) return;
    source_->cancel(at->second);
    outer_of_.erase(static_cast<std::uint64_t>(at->second));
    inner_of_.erase(at);
  }

  void prioritize(Ticket ticket, float priority) override {
    const std::lock_guard guard(lock_);
    const auto number = static_cast<std::uint64_t>(ticket);
    if (const auto at = waiting_.find(number); at != waiting_.end()) {
      at->second.priority = priority;
    } else if (const auto inner = inner_of_.find(number); inner != inner_of_.end()) {
      source_->prioritize(inner->second, priority);
    }
  }

  void give_back(std::uint64_t offset, std::vector<std::byte> bytes) override {
    source_->give_back(offset, std::move(bytes));
  }

  std::vector<AsyncAnswer> poll() override {
    const std::lock_guard guard(lock_);
    pass();
    take_answers();
    return std::exchange(answers_, {});
  }

  bool wait(std::chrono::milliseconds timeout) override {
    constexpr std::chrono::milliseconds kLongestLook{20};  // another thread may ask meanwhile
    const RateLimit::Clock::time_point end = RateLimit::Clock::now() + timeout;
    for (;;) {
      const bool is_last = RateLimit::Clock::now() >= end;
      bool is_outstanding = false;
      {
        const std::lock_guard guard(lock_);
        pass();
        take_answers();
        if (!answers_.empty()) return true;
        if (waiting_.empty() && inner_of_.empty()) return false;
        is_outstanding = !inner_of_.empty();
      }
      if (is_last) return false;
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - RateLimit::Clock::now());
      const auto look = std::clamp(left, std::chrono::milliseconds(0), kLongestLook);
      if (is_outstanding) {
        source_->wait(look);
      } else {
        std::this_thread::sleep_for(std::min<RateLimit::Clock::duration>(look, limit_->pause()));
      }
    }
  }

  AsyncStatistics statistics() const override {
    const std::lock_guard guard(lock_);
    AsyncStatistics told = source_->statistics();
    told.asked += waiting_.size() + cancelled_.asked;
    told.cancelled += cancelled_.cancelled;
    told.bytes_asked += cancelled_.bytes_asked;
    for (const auto& [number, range] : waiting_) told.bytes_asked += range.range.bytes;
    return told;
  }

 private:
  // What may pass now, in one request, so that neighbours are still asked for together.
  void pass() {
    std::vector<RangeRequest> ranges;
    std::vector<std::uint64_t> numbers;
    while (!waiting_.empty()) {
      const auto most_urgent =
          std::max_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
            return a.second.priority < b.second.priority;  // of equal ones the first
          });
      if (!limit_->take(most_urgent->second.range.bytes)) break;
      ranges.push_back(most_urgent->second);
      numbers.push_back(most_urgent->first);
      waiting_.erase(most_urgent);
    }
    if (ranges.empty()) return;
    const Ticket first = source_->request(ranges);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const Ticket inner = ticket_after(first, i);
      inner_of_.emplace(numbers[i], inner);
      outer_of_.emplace(static_cast<std::uint64_t>(inner), numbers[i]);
    }
  }

  void take_answers() {
    for (AsyncAnswer& answer : source_->poll()) {
      const auto at = outer_of_.find(static_cast<std::uint64_t>(answer.ticket));
      if (at == outer_of_.end()) continue;
      inner_of_.erase(at->second);
      answers_.push_back({static_cast<Ticket>(at->second), std::move(answer.bytes)});
      outer_of_.erase(at);
    }
  }

  const AsyncSourcePtr source_;
  const std::shared_ptr<RateLimit> limit_;
  mutable std::mutex lock_;
  std::uint64_t next_ticket_ = 0;
  std::map<std::uint64_t, RangeRequest> waiting_;  // by ticket
  std::unordered_map<std::uint64_t, Ticket> inner_of_;
  std::unordered_map<std::uint64_t, std::uint64_t> outer_of_;
  std::vector<AsyncAnswer> answers_;
  AsyncStatistics cancelled_;  // while they waited here
};

}  // namespace

AsyncSourcePtr limited_source(AsyncSourcePtr source, std::shared_ptr<RateLimit> limit) {
  return std::make_shared<LimitedSource>(std::move(source), std::move(limit));
}

}  // namespace crease
