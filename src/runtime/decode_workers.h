// Threads that decode blocks, one after the other, in the order in which they were given, then the
// names of parts, and while there is nothing to decode make vertex hierarchies, or levels, of those
// that are there.
//
//   workers.add(job, payload);
//   ... each frame:
//   for (DecodeWorkers::Decoded& decoded : workers.take()) ...
//   workers.hand_over();
//
// One thread calls, and only wait() ever waits. What it adds lies on its own side until take() or
// hand_over() meets the lock free, and what is done on the threads' side likewise; so a frame may
// hear a little later, but not stand still because a thread was stopped while it held the lock.
// Vectors go to and fro whole: to free them may wait too, since the allocator has locks.
#pragma once

#include "base/bell.h"
#include "crease/block_mesh.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace crease {

// The section of a file, whose checksum is right.
struct PartNamesJob {
  std::vector<std::byte> bytes;
  std::uint32_t count = 0;
  std::vector<std::string> run() const;  // empty where they are none
};

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
  void add(BlockHierarchyJob job);
  void add(BlockLevelsJob job);
  void add(PartNamesJob job);
  // On one of the threads, before anything else. Without threads at once.
  void free(std::vector<UnusedPtr> unused);
  void free(UnusedPtr unused);
  void hand_over();

  // Those that are done since the last call; until the next one.
  std::span<Decoded> take();
  std::span<BlockHierarchyPtr> take_hierarchies();   // after take()
  std::span<BlockLevelsPtr> take_levels();           // likewise
  std::span<std::vector<std::string>> take_names();  // likewise

  std::size_t outstanding() const { return decoding_.outstanding; }  // blocks added and not taken
  std::size_t outstanding_making() const {  // hierarchies and levels, likewise
    return hierarchies_.outstanding + levels_.outstanding;
  }
  double seconds() const { return seconds_; }  // spent decoding, over all threads
  // Until one of them has something (true), or the time is over. Not without threads.
  bool wait(std::chrono::milliseconds timeout);

 private:
  struct Payload {
    BlockDecodeJob job;
    std::vector<std::byte> bytes;
  };

  // The way of one kind of job, from the caller's side to the threads' and back.
  template <typename Job, typename Made>
  struct Kind {
    std::vector<Job> added;   // the caller's side
    std::vector<Job> given;   // under the lock, as all that follow
    std::deque<Job> waiting;  // taken from there by the threads
    std::vector<Made> done;
    std::vector<Made> arrived, taken;  // the caller's side
    std::size_t outstanding = 0;       // likewise

    void add(Job job);
    void meet();
    std::span<Made> take();
    bool has_waiting() const { return !given.empty() || !waiting.empty(); }
    Job next();
  };

  void work();
  void meet();
  bool has_waiting() const {
    return decoding_.has_waiting() || hierarchies_.has_waiting() || levels_.has_waiting() ||
           names_.has_waiting();
  }
  // The lock is held before and after, not while they work. Something must be waiting.
  void free_given(std::unique_lock<std::mutex>& lock);
  void do_next(std::unique_lock<std::mutex>& lock);
  void decode_next(std::unique_lock<std::mutex>& lock);
  template <typename Job, typename Made>
  void make_next(std::unique_lock<std::mutex>& lock, Kind<Job, Made>& kind);

  mutable std::mutex mutex_;
  Bell has_work_;
  std::condition_variable has_results_;
  Kind<Payload, Decoded> decoding_;
  Kind<BlockHierarchyJob, BlockHierarchyPtr> hierarchies_;
  Kind<BlockLevelsJob, BlockLevelsPtr> levels_;
  Kind<PartNamesJob, std::vector<std::string>> names_;
  std::vector<UnusedPtr> unused_;        // the caller's side
  std::vector<UnusedPtr> given_unused_;  // under the lock
  std::atomic<double> seconds_ = 0;      // changed under the lock
  bool is_ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace crease
