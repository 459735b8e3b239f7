// The tool's global operator new, which follows a limit of memory once there is one.
//
// Until then it is malloc() as ever. Builds with a sanitizer keep the sanitizer's own, which finds
// errors that ours would hide.
#pragma once

#include "crease/memory_limit.h"

namespace crease::cli {

#ifdef CREASE_SANITIZED
inline constexpr bool kCanLimitMemory = false;
#else
inline constexpr bool kCanLimitMemory = true;
#endif

// All allocations go there from now on.
void allocate_from(MemoryLimit& limit);
// From malloc() again, so that there is memory to say that there was none.
void allocate_without_limit();
// Null before allocate_from().
MemoryLimit* memory_limit();

}  // namespace crease::cli
