// --memory SIZE: a limit of resident memory, beyond which large arrays live in a file.
//
//   Result<MemoryOption> memory = limit_memory("512MB", "city.crease", common);
//   ...the work; its global operator new follows the limit (global_new.cpp)
//   log(common, memory->spilled_line());
#pragma once

#include "cli/command.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace crease::cli {

struct MemoryOption {
  std::uint64_t limit = 0;  // bytes; 0: none
  std::filesystem::path folder;

  // The most bytes of arrays that were in the file at once.
  std::uint64_t spilled_bytes() const;
  // In words, of a limit above 0.
  std::string spilled_line() const;
};

void add_memory_option(CLI::App& command, std::string& size);

// From here on, to the end of the process; "0" changes nothing. The file is in TMPDIR, or, where
// that is not set or in memory itself, in the folder of `output`: a disk that has room for results.
// Fails when the file cannot be made. Once.
Result<MemoryOption> limit_memory(const std::string& size, const std::filesystem::path& output,
                                  const Common& common);

// After std::bad_alloc: why, if the disk had no room for an allocation. What is allocated from then
// on is ordinary memory.
std::optional<Failure> spill_failure();

}  // namespace crease::cli
