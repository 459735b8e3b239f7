// Threads that decode blocks, one after the other, in the order in which they were given, and while
// there is nothing to decode make vertex hierarchies, or levels, of those that are there.
#pragma once

#include "crease/block_mesh.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

namespace crease {

class DecodeWorkers {
 public:
  struct Decoded {
    BlockId id{};
    Result<ResidentBlockPtr> block;
  };

  // 0: take() does one of them on the caller's.
  explicit DecodeWorkers(int threads);
  ~DecodeWorkers();  // waits for those that are being decoded; what waits is left
  DecodeWorkers(const DecodeWorkers&) = delete;
  DecodeWorkers& operator=(const DecodeWorkers&) = delete;

  void add(BlockDecodeJob job, std::vector<std::byte> payload);
  // Those that are done since the last call.
  std::vector<Decoded> take();

  void add(BlockHierarchyJob job);
  std::vector<BlockHierarchyPtr> take_hierarchies();  // after take()

  void add(BlockLevelsJob job);
  std::vector<BlockLevelsPtr> take_levels();  // likewise

  // On one of the threads, before anything else: the allocator has a lock, which those that decode
  // hold at times. Without threads at once.
  void free(std::vector<ResidentBlockPtr> blocks);

  std::size_t outstanding() const;         // blocks added and not taken
  std::size_t outstanding_making() const;  // hierarchies and levels, likewise
  double seconds() const;                  // spent decoding, over all threads
  // Until one of them has something (true), or the time is over. Not without threads.
  bool wait(std::chrono::milliseconds timeout);

 private:
  struct Waiting {
    BlockDecodeJob job;
    std::vector<std::byte> payload;
  };

  // What is made of blocks that are there.
  template <typename Job, typename Made>
  struct Making {
    std::deque<Job> waiting;
    std::vector<Made> done;
  };

  void work();
  void free_unused(std::unique_lock<std::mutex>& lock);
  bool has_waiting() const {
    return !waiting_.empty() || !hierarchies_.waiting.empty() || !levels_.waiting.empty();
  }
  // The lock is held before and after, not while it works. Something must be waiting.
  void do_next(std::unique_lock<std::mutex>& lock);
  void decode_next(std::unique_lock<std::mutex>& lock);
  template <typename Job, typename Made>
  void add(Making<Job, Made>& making, Job job);
  template <typename Job, typename Made>
  std::vector<Made> take(Making<Job, Made>& making);
  template <typename Job, typename Made>
  void make_next(std::unique_lock<std::mutex>& lock, Making<Job, Made>& making);

  mutable std::mutex mutex_;
  std::condition_variable has_work_, has_results_;
  std::vector<ResidentBlockPtr> unused_;
  std::deque<Waiting> waiting_;
  std::vector<Decoded> done_;
  Making<BlockHierarchyJob, BlockHierarchyPtr> hierarchies_;
  Making<BlockLevelsJob, BlockLevelsPtr> levels_;
  std::size_t outstanding_ = 0, outstanding_making_ = 0;
  double seconds_ = 0;
  bool is_ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace crease
