#include "runtime/decode_workers.h"

#include "codec/decode_container.h"

#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>

namespace crease {

namespace {

// Of two sides, where the one that gives keeps the other's memory if it can.
template <typename Thing>
void hand(std::vector<Thing>& from, std::vector<Thing>& to) {
  if (to.empty()) {
    to.swap(from);
    return;
  }
  std::move(from.begin(), from.end(), std::back_inserter(to));
  from.clear();
}

}  // namespace

template <typename Job, typename Made>
void DecodeWorkers::Kind<Job, Made>::add(Job job) {
  added.push_back(std::move(job));
  ++outstanding;
}

template <typename Job, typename Made>
void DecodeWorkers::Kind<Job, Made>::meet() {
  hand(added, given);
  hand(done, arrived);
}

template <typename Job, typename Made>
std::span<Made> DecodeWorkers::Kind<Job, Made>::take() {
  taken.clear();
  hand(arrived, taken);
  outstanding -= taken.size();
  return taken;
}

template <typename Job, typename Made>
Job DecodeWorkers::Kind<Job, Made>::next() {
  std::move(given.begin(), given.end(), std::back_inserter(waiting));
  given.clear();
  Job job = std::move(waiting.front());
  waiting.pop_front();
  return job;
}

std::vector<std::string> PartNamesJob::run() const {
  Result<std::vector<std::string>> names = decode_parts(bytes, count);
  return names.ok() ? *std::move(names) : std::vector<std::string>();
}

DecodeWorkers::DecodeWorkers(int threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

DecodeWorkers::~DecodeWorkers() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_work_.ring();
  for (std::thread& thread : threads_) thread.join();
}

void DecodeWorkers::add(BlockDecodeJob job, std::vector<std::byte> payload) {
  decoding_.add({std::move(job), std::move(payload)});
}
void DecodeWorkers::add(BlockHierarchyJob job) {
  hierarchies_.add(std::move(job));
}
void DecodeWorkers::add(BlockLevelsJob job) {
  levels_.add(std::move(job));
}
void DecodeWorkers::add(PartNamesJob job) {
  names_.add(std::move(job));
}

void DecodeWorkers::free(UnusedPtr unused) {
  if (!threads_.empty()) unused_.push_back(std::move(unused));
}
void DecodeWorkers::free(std::vector<UnusedPtr> unused) {
  for (UnusedPtr& one : unused) free(std::move(one));
}

// Under the lock.
void DecodeWorkers::meet() {
  decoding_.meet();
  hierarchies_.meet();
  levels_.meet();
  names_.meet();
  hand(unused_, given_unused_);
}

void DecodeWorkers::hand_over() {
  bool has_work = false;
  {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return;
    meet();
    has_work = has_waiting() || !given_unused_.empty();
  }
  if (has_work) has_work_.ring();
}

std::span<DecodeWorkers::Decoded> DecodeWorkers::take() {
  hand_over();
  if (threads_.empty() && has_waiting()) {
    std::unique_lock lock(mutex_);
    do_next(lock);
    meet();
  }
  return decoding_.take();
}
std::span<BlockHierarchyPtr> DecodeWorkers::take_hierarchies() {
  return hierarchies_.take();
}
std::span<BlockLevelsPtr> DecodeWorkers::take_levels() {
  return levels_.take();
}
std::span<std::vector<std::string>> DecodeWorkers::take_names() {
  return names_.take();
}

bool DecodeWorkers::wait(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  meet();
  has_work_.ring();
  const auto has_results = [this] {
    meet();
    return !decoding_.arrived.empty() || !hierarchies_.arrived.empty() ||
           !levels_.arrived.empty() || !names_.arrived.empty();
  };
  return has_results_.wait_for(lock, timeout, has_results);
}

void DecodeWorkers::work() {
  for (;;) {
    const std::uint32_t heard = has_work_.rings();
    {
      std::unique_lock lock(mutex_);
      while (!is_ending_ && (!given_unused_.empty() || has_waiting())) {
        free_given(lock);
        if (!is_ending_ && has_waiting()) do_next(lock);
      }
      if (is_ending_) return;
    }
    has_work_.wait(heard);
  }
}

void DecodeWorkers::free_given(std::unique_lock<std::mutex>& lock) {
  if (given_unused_.empty()) return;
  std::vector<UnusedPtr> unused = std::exchange(given_unused_, {});
  lock.unlock();
  unused.clear();
  lock.lock();
}

void DecodeWorkers::do_next(std::unique_lock<std::mutex>& lock) {
  if (decoding_.has_waiting()) return decode_next(lock);
  if (names_.has_waiting()) return make_next(lock, names_);
  if (hierarchies_.has_waiting()) return make_next(lock, hierarchies_);
  make_next(lock, levels_);
}

template <typename Job, typename Made>
void DecodeWorkers::make_next(std::unique_lock<std::mutex>& lock, Kind<Job, Made>& kind) {
  std::optional<Job> job = kind.next();
  lock.unlock();
  Made made = job->run();
  job.reset();
  lock.lock();
  kind.done.push_back(std::move(made));
  has_results_.notify_all();
}

void DecodeWorkers::decode_next(std::unique_lock<std::mutex>& lock) {
  using Clock = std::chrono::steady_clock;
  std::optional<Payload> next = decoding_.next();
  lock.unlock();
  const Clock::time_point start = Clock::now();
  Decoded decoded{next->job.entry().id, next->job.run(next->bytes)};
  const std::chrono::duration<double> took = Clock::now() - start;
  next.reset();
  lock.lock();
  seconds_ = seconds_ + took.count();
  decoding_.done.push_back(std::move(decoded));
  has_results_.notify_all();
}

}  // namespace crease
