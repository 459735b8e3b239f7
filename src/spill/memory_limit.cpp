#include "crease/memory_limit.h"

#include "base/assert.h"
#include "spill/resident_memory.h"
#include "spill/small_pieces.h"
#include "spill/spill_file.h"

#include <linux/magic.h>
#include <malloc.h>
#include <sys/vfs.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <utility>

namespace crease {

namespace {

// What is as large is an array, with pages of the file to itself. Most of a build's memory is
// arrays of 16 KB to 500 KB, which patches have; what is smaller are millions of pieces.
constexpr std::size_t kArray = 16 << 10;

// Ordinary memory is faster. Of the limit, but for what was resident before and the margin, arrays
// have one part in so many, and all the rest.
constexpr std::uint64_t kOfArrays = 2, kOfPieces = 4;

// So much of a file goes out of memory at a time, or this part of it, so that a round takes no more
// than milliseconds.
constexpr std::uint64_t kStep = 4 << 20, kStepsOfRound = 128;

// How long until the next look, and sooner after one that found too much: a read of one page brings
// its neighbours in too, so that memory may grow by gigabytes a second.
constexpr std::chrono::microseconds kWatch{1000}, kWatchSharply{200};
// Where all processors are busy the watching thread may have to wait for long, even while it
// unmaps: whoever allocates an array looks if nobody did for so long.
constexpr std::chrono::milliseconds kLate{1};
// When all went out and that was not enough, it is no use to look again at once.
constexpr std::chrono::microseconds kRest{4000};
// malloc() keeps what small pieces were freed into; to have it look takes it milliseconds.
constexpr std::chrono::milliseconds kTrim{200};

}  // namespace

struct MemoryLimit::State {
  std::uint64_t limit = 0;
  std::unique_ptr<spill::SpillFile> arrays, pages_of_pieces;
  std::unique_ptr<spill::SmallPieces> pieces;
  spill::ResidentMemory at_start;
  std::atomic<std::int64_t> ordinary_arrays{0};  // bytes that allocate() had from malloc()
  std::atomic<std::uint64_t> ordinary_seen{0};   // resident and of no file, when last looked at
  std::chrono::steady_clock::time_point next_trim{};  // of the watching thread
  std::atomic<std::chrono::steady_clock::time_point> last_look{};

  // Memory grows while somebody looks.
  std::uint64_t margin() const { return limit / 8; }
  // What is for ordinary memory and for the window of the files.
  std::uint64_t available() const {
    const std::uint64_t others = at_start.of_files + at_start.ordinary + margin();
    return limit > others ? limit - others : 0;
  }
  bool has_ordinary_room_for_array(std::size_t bytes) const;
  std::uint64_t arrays_in_ordinary() const {
    // Some were there before the limit, so that more may be freed than were counted.
    return static_cast<std::uint64_t>(std::max<std::int64_t>(0, ordinary_arrays));
  }
  std::uint64_t pieces_in_ordinary() const {
    const std::uint64_t all = ordinary_seen, of_arrays = arrays_in_ordinary();
    return all > of_arrays ? all - of_arrays : 0;
  }
  void* allocate_array(std::size_t bytes);
  [[noreturn]] void watch();
  std::chrono::microseconds look();
  void look_if_late();
  void trim_now_and_then();
  bool unmap_down_to(std::uint64_t window);
};

namespace {

std::atomic<bool> is_started{false};

// Of what malloc() gave, as it may give a bit more than it was asked for: arrays but for the
// smallest, and no piece.
std::int64_t counted_bytes_of(void* memory) {
  const std::size_t bytes = malloc_usable_size(memory);
  return bytes >= kArray + 64 ? static_cast<std::int64_t>(bytes) : 0;
}

}  // namespace

Result<MemoryLimit*> MemoryLimit::start(const MemoryLimitOptions& options) {
  CREASE_ASSERT(!is_started.exchange(true));
  Result<std::unique_ptr<spill::SpillFile>> arrays = spill::SpillFile::create(options.folder);
  if (!arrays.ok()) return arrays.failure();
  Result<std::unique_ptr<spill::SpillFile>> pages = spill::SpillFile::create(options.folder);
  if (!pages.ok()) return pages.failure();
  // What is large goes back to the system when it is freed, whatever was freed before.
  mallopt(M_MMAP_THRESHOLD, 128 << 10);
  mallopt(M_TRIM_THRESHOLD, 128 << 10);
  auto* state = new State;
  state->limit = options.bytes;
  state->arrays = *std::move(arrays);
  state->pages_of_pieces = *std::move(pages);
  state->pieces = std::make_unique<spill::SmallPieces>(*state->pages_of_pieces);
  state->at_start = spill::resident_memory();
  state->ordinary_seen = state->at_start.ordinary;
  std::thread([state] { state->watch(); }).detach();
  return new MemoryLimit(state);
}

bool MemoryLimit::State::has_ordinary_room_for_array(std::size_t bytes) const {
  // What was allocated and not yet touched is not resident.
  const std::uint64_t all = std::max<std::uint64_t>(arrays_in_ordinary(), ordinary_seen);
  const std::uint64_t most = available() / kOfArrays;
  return bytes < most && all < most - bytes;
}

void* MemoryLimit::State::allocate_array(std::size_t bytes) {
  look_if_late();
  if (!has_ordinary_room_for_array(bytes)) return arrays->allocate(bytes);
  void* memory = std::malloc(bytes);
  if (memory != nullptr) ordinary_arrays += counted_bytes_of(memory);
  return memory;
}

void* MemoryLimit::allocate(std::size_t bytes) noexcept {
  if (bytes >= kArray) return state_->allocate_array(bytes);
  if (state_->pieces_in_ordinary() >= state_->available() / kOfPieces) {
    return state_->pieces->allocate(bytes);
  }
  return std::malloc(bytes);
}

void MemoryLimit::free(void* memory) noexcept {
  if (state_->arrays->holds(memory)) return state_->arrays->free(memory);
  if (state_->pages_of_pieces->holds(memory)) return state_->pieces->free(memory);
  if (const std::int64_t bytes = counted_bytes_of(memory); bytes > 0) {
    state_->ordinary_arrays -= bytes;
  }
  std::free(memory);
}

// One round of the files at most, the denser one with the pieces last. False: that was not enough.
bool MemoryLimit::State::unmap_down_to(std::uint64_t window) {
  for (spill::SpillFile* file : {arrays.get(), pages_of_pieces.get()}) {
    const std::uint64_t step = std::max(kStep, file->size() / (kStepsOfRound * kStep) * kStep);
    for (std::uint64_t done = 0; done < file->size(); done += step) {
      file->unmap_next(step);
      last_look = std::chrono::steady_clock::now();
      if (spill::resident_memory().of_files <= at_start.of_files + window) return true;
    }
  }
  return false;
}

// Where much of what is small was freed, as after an import, the system has it back.
void MemoryLimit::State::trim_now_and_then() {
  const auto now = std::chrono::steady_clock::now();
  if (pieces_in_ordinary() < available() / (2 * kOfPieces) || now < next_trim) return;
  malloc_trim(0);
  next_trim = now + kTrim;
}

// Unmaps what is too much. Returns how long that will do.
std::chrono::microseconds MemoryLimit::State::look() {
  last_look = std::chrono::steady_clock::now();
  const spill::ResidentMemory now = spill::resident_memory();
  ordinary_seen = now.ordinary;
  const std::uint64_t others = now.ordinary + at_start.of_files + margin();
  const std::uint64_t window = std::max(limit > others ? limit - others : 0, kLeastWindow);
  if (now.of_files <= at_start.of_files + window) return kWatch;
  return unmap_down_to(window - window / 8) ? kWatchSharply : kRest;
}

void MemoryLimit::State::look_if_late() {
  if (std::chrono::steady_clock::now() >= last_look.load() + kLate) look();
}

void MemoryLimit::State::watch() {
  while (true) {
    trim_now_and_then();
    std::this_thread::sleep_for(look());
  }
}

bool MemoryLimit::holds(const void* address) const noexcept {
  return state_->arrays->holds(address) || state_->pages_of_pieces->holds(address);
}

std::uint64_t MemoryLimit::spilled() const {
  return state_->arrays->most_used() + state_->pages_of_pieces->most_used();
}

std::string MemoryLimit::failure() const {
  const std::string of_arrays = state_->arrays->failure();
  return of_arrays.empty() ? state_->pages_of_pieces->failure() : of_arrays;
}

bool MemoryLimit::is_in_memory(const std::filesystem::path& folder) {
  struct statfs facts {};
  return ::statfs(folder.c_str(), &facts) == 0 &&
         (facts.f_type == TMPFS_MAGIC || facts.f_type == RAMFS_MAGIC);
}

}  // namespace crease
