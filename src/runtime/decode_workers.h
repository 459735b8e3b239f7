// Threads that decode blocks, one after the other, in the order in which they were given.
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

  // 0: take() decodes one block on the caller's.
  explicit DecodeWorkers(int threads);
  ~DecodeWorkers();  // waits for those that are being decoded; what waits is left
  DecodeWorkers(const DecodeWorkers&) = delete;
  DecodeWorkers& operator=(const DecodeWorkers&) = delete;

  void add(BlockDecodeJob job, std::vector<std::byte> payload);
  // Those that are done since the last call.
  std::vector<Decoded> take();

  std::size_t outstanding() const;  // added and not taken
  double seconds() const;           // spent decoding, over all threads
  // Until take() has something (true), or the time is over. Not without threads.
  bool wait(std::chrono::milliseconds timeout);

 private:
  struct Waiting {
    BlockDecodeJob job;
    std::vector<std::byte> payload;
  };

  void work();
  // The lock is held before and after, not while it decodes.
  void decode_next(std::unique_lock<std::mutex>& lock);

  mutable std::mutex mutex_;
  std::condition_variable has_work_, has_results_;
  std::deque<Waiting> waiting_;
  std::vector<Decoded> done_;
  std::size_t outstanding_ = 0;
  double seconds_ = 0;
  bool is_ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace crease
