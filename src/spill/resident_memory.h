// How much of the process is in memory now.
#pragma once

#include <cstdint>

namespace crease::spill {

struct ResidentMemory {
  std::uint64_t ordinary = 0;  // bytes: heap, stacks
  std::uint64_t of_files = 0;  // bytes: mapped files, code and libraries among them
};

// From /proc/self/statm; zeros where there is none. Allocates nothing.
ResidentMemory resident_memory();

}  // namespace crease::spill
