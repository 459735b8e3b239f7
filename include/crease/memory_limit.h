// Keeps a process near a limit of resident memory: what is beyond it lives in a file.
//
//   Result<MemoryLimit*> limit = MemoryLimit::start({.bytes = 512 << 20, .folder = "/data"});
//   void* memory = (*limit)->allocate(size);    // what a replaced operator new calls from then on
//   (*limit)->free(memory);
//   std::uint64_t bytes = (*limit)->spilled();  // the most that the file held at once
//
// At most half of the limit is ordinary memory. Once that is full, allocations are pages of a file
// without a name, mapped and shared. A thread looks every millisecond how much is resident, and
// when that nears the limit it unmaps pages of the file, one piece after the other. The system has
// them in its cache while it has memory to spare, writes them to the disk when it has not, and
// brings them back when they are touched: unlike ordinary memory, which without swap stays where it
// is. What it costs are those returns.
//
// For a tool whose global operator new calls it. Linux.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace crease {

struct MemoryLimitOptions {
  std::uint64_t bytes = 0;  // resident, of the whole process, its code and libraries among them
  // Where the file goes. It needs room for as many bytes as are allocated at once, and nothing is
  // left of it however the process ends.
  std::filesystem::path folder;
};

class MemoryLimit {
 public:
  // So many bytes of the file may be resident however low the limit is.
  static constexpr std::uint64_t kLeastWindow = 32 << 20;

  // Once in a process. It is never deleted, as memory may be freed while the process ends. Fails
  // with WriteFailed where the folder takes no file, with NotSupported where addresses are limited
  // (ulimit -v).
  static Result<MemoryLimit*> start(const MemoryLimitOptions& options);

  // `bytes`: above 0. Aligned as by malloc(). Null when there is no memory, or no room for the
  // file, of which failure() tells. Threads: any.
  [[nodiscard]] void* allocate(std::size_t bytes) noexcept;
  // Of what allocate() or malloc() gave, null too. Threads: any.
  void free(void* memory) noexcept;

  // An access to such an address ends in SIGBUS when the disk cannot give the page back.
  bool holds(const void* address) const noexcept;
  // The most bytes that were in the file at once.
  std::uint64_t spilled() const;
  // Why allocate() gave null for want of room, with folder and reason. Empty: it did not.
  std::string failure() const;
  // A folder that is in memory itself (tmpfs): a limit that has its file there saves none.
  static bool is_in_memory(const std::filesystem::path& folder);

 private:
  struct State;
  explicit MemoryLimit(State* state) : state_(state) {}
  State* state_;
};

}  // namespace crease
