// A file without a name whose bytes are used as memory.
//
//   Result<std::unique_ptr<SpillFile>> file = SpillFile::create("/data");
//   void* memory = (*file)->allocate(1 << 20);   // mapped, and there is room for it on the disk
//   (*file)->unmap_next(4 << 20);                // resident no more; contents stay
//   (*file)->free(memory);
//
// The file grows by kGrowth and its room on the disk is taken before it is used, so that a full
// disk fails an allocation and not an access. It never shrinks: what is free keeps its room, but
// its contents are forgotten and need not be written. Threads: any, but for create().
#pragma once

#include "crease/result.h"
#include "spill/file_ranges.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

namespace crease::spill {

class SpillFile {
 public:
  static constexpr std::uint64_t kGrowth = 64 << 20;
  static constexpr std::uint64_t kMostBytes = std::uint64_t(1) << 40;  // addresses that it reserves

  static Result<std::unique_ptr<SpillFile>> create(const std::filesystem::path& folder);
  ~SpillFile();
  SpillFile(const SpillFile&) = delete;
  SpillFile& operator=(const SpillFile&) = delete;

  // Null: no room, which failure() tells of. Aligned to pages.
  [[nodiscard]] void* allocate(std::size_t bytes);
  void free(void* memory);  // of this file

  bool holds(const void* address) const {
    return reinterpret_cast<std::uintptr_t>(address) - reinterpret_cast<std::uintptr_t>(base_) <
           kMostBytes;
  }
  // Takes the next `bytes` of the file out of memory, round and round. Waits for no other call.
  void unmap_next(std::uint64_t bytes);
  std::uint64_t size() const { return size_; }  // bytes, free ones among them

  std::uint64_t most_used() const;  // bytes
  std::string failure() const;      // folder and reason; empty: none

 private:
  SpillFile(std::filesystem::path folder, int descriptor, std::byte* base)
      : folder_(std::move(folder)), descriptor_(descriptor), base_(base) {}
  bool grow_to(std::uint64_t size);
  void throw_away(const Range& range) const;

  const std::filesystem::path folder_;
  const int descriptor_;
  std::byte* const base_;                        // where offset 0 of the file is
  std::atomic<std::uint64_t> size_{0};           // of the file; all of it is mapped
  std::atomic<std::uint64_t> next_to_unmap_{0};  // counted on through all rounds
  mutable std::mutex mutex_;                     // guards what follows
  FileRanges ranges_;
  std::uint64_t most_used_ = 0;
  int error_ = 0;  // the system's, of the last allocation that failed
};

}  // namespace crease::spill
