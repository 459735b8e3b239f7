#include "runtime/decode_workers.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace crease {

DecodeWorkers::DecodeWorkers(int threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

DecodeWorkers::~DecodeWorkers() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_work_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void DecodeWorkers::add(BlockDecodeJob job, std::vector<std::byte> payload) {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(job), std::move(payload)});
    ++outstanding_;
  }
  has_work_.notify_one();
}

std::vector<DecodeWorkers::Decoded> DecodeWorkers::take() {
  std::unique_lock lock(mutex_);
  if (threads_.empty() && has_waiting()) do_next(lock);
  outstanding_ -= done_.size();
  return std::exchange(done_, {});
}

template <typename Job, typename Made>
void DecodeWorkers::add(Making<Job, Made>& making, Job job) {
  {
    const std::lock_guard lock(mutex_);
    making.waiting.push_back(std::move(job));
    ++outstanding_making_;
  }
  has_work_.notify_one();
}

template <typename Job, typename Made>
std::vector<Made> DecodeWorkers::take(Making<Job, Made>& making) {
  const std::lock_guard lock(mutex_);
  outstanding_making_ -= making.done.size();
  return std::exchange(making.done, {});
}

void DecodeWorkers::add(BlockHierarchyJob job) {
  add(hierarchies_, std::move(job));
}
void DecodeWorkers::add(BlockLevelsJob job) {
  add(levels_, std::move(job));
}
std::vector<BlockHierarchyPtr> DecodeWorkers::take_hierarchies() {
  return take(hierarchies_);
}
std::vector<BlockLevelsPtr> DecodeWorkers::take_levels() {
  return take(levels_);
}

std::size_t DecodeWorkers::outstanding_making() const {
  const std::lock_guard lock(mutex_);
  return outstanding_making_;
}

std::size_t DecodeWorkers::outstanding() const {
  const std::lock_guard lock(mutex_);
  return outstanding_;
}

double DecodeWorkers::seconds() const {
  const std::lock_guard lock(mutex_);
  return seconds_;
}

bool DecodeWorkers::wait(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return has_results_.wait_for(lock, timeout, [this] {
    return !done_.empty() || !hierarchies_.done.empty() || !levels_.done.empty();
  });
}

void DecodeWorkers::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    has_work_.wait(lock, [this] { return is_ending_ || !unused_.empty() || has_waiting(); });
    if (is_ending_) return;
    free_unused(lock);
    if (has_waiting()) do_next(lock);
  }
}

void DecodeWorkers::free(std::vector<ResidentBlockPtr> blocks) {
  if (threads_.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    std::move(blocks.begin(), blocks.end(), std::back_inserter(unused_));
  }
  has_work_.notify_one();
}

void DecodeWorkers::free_unused(std::unique_lock<std::mutex>& lock) {
  std::vector<ResidentBlockPtr> unused = std::exchange(unused_, {});
  if (unused.empty()) return;
  lock.unlock();
  unused.clear();
  lock.lock();
}

void DecodeWorkers::do_next(std::unique_lock<std::mutex>& lock) {
  if (!waiting_.empty()) return decode_next(lock);
  if (!hierarchies_.waiting.empty()) return make_next(lock, hierarchies_);
  make_next(lock, levels_);
}

template <typename Job, typename Made>
void DecodeWorkers::make_next(std::unique_lock<std::mutex>& lock, Making<Job, Made>& making) {
  const Job job = std::move(making.waiting.front());
  making.waiting.pop_front();
  lock.unlock();
  Made made = job.run();
  lock.lock();
  making.done.push_back(std::move(made));
  has_results_.notify_all();
}

void DecodeWorkers::decode_next(std::unique_lock<std::mutex>& lock) {
  using Clock = std::chrono::steady_clock;
  Waiting next = std::move(waiting_.front());
  waiting_.pop_front();
  lock.unlock();
  const Clock::time_point start = Clock::now();
  Result<ResidentBlockPtr> block = next.job.run(next.payload);
  const std::chrono::duration<double> took = Clock::now() - start;
  lock.lock();
  seconds_ += took.count();
  done_.push_back({next.job.entry().id, std::move(block)});
  has_results_.notify_all();
}

}  // namespace crease
