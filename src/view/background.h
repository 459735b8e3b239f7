// Long work on a thread of its own, that a window asks about every frame.
//
//   Background<DecodedModel> work([](Note& note) -> Result<DecodedModel> { ... });
//   every frame:  if (work.is_done()) use(work.take());
#pragma once

#include "crease/progress.h"
#include "crease/result.h"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace crease {

// What work tells of itself, and what it is told. Threads: any.
class Note {
 public:
  void say(std::string stage, double share = -1) {
    const std::lock_guard lock(mutex_);
    stage_ = std::move(stage);
    share_ = share;
  }
  std::string stage() const {
    const std::lock_guard lock(mutex_);
    return stage_;
  }
  // 0 to 1; negative: nobody knows.
  double share() const {
    const std::lock_guard lock(mutex_);
    return share_;
  }
  void stop() { is_stopped_ = true; }
  bool is_stopped() const { return is_stopped_; }

  // For options of the library. The note must outlive it.
  ProgressCallback progress() {
    return [this](const char* stage, double done) {
      say(stage, done);
      return !is_stopped();
    };
  }

 private:
  mutable std::mutex mutex_;
  std::string stage_;
  double share_ = -1;
  std::atomic<bool> is_stopped_{false};
};

template <typename T>
class Background {
 public:
  explicit Background(std::function<Result<T>(Note&)> work)
      : shared_(std::make_unique<Shared>()),
        thread_([shared = shared_.get(), work = std::move(work)] {
          shared->result.emplace(work(shared->note));
          shared->is_done = true;
        }) {}
  Background(Background&&) noexcept = default;
  // For containers, which assign to what they moved from: work that goes on is never lost.
  Background& operator=(Background&& other) noexcept {
    std::swap(shared_, other.shared_);
    std::swap(thread_, other.thread_);
    return *this;
  }
  // Asks the work to stop and waits until it has.
  ~Background() {
    if (shared_) shared_->note.stop();
    if (thread_.joinable()) thread_.join();
  }

  // Asks it to stop, and does not wait.
  void stop() { shared_->note.stop(); }

  const Note& note() const { return shared_->note; }
  bool is_done() const { return shared_->is_done; }
  // Once, when it is done.
  Result<T> take() { return *std::move(shared_->result); }

 private:
  struct Shared {
    Note note;
    std::optional<Result<T>> result;  // written before is_done, read after it
    std::atomic<bool> is_done{false};
  };
  std::unique_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace crease
