// CREASE_WIDE before a function: it is compiled twice, and the wider one is taken where the
// processor has it. No products are fused, so both give the same to the bit. Not in a module with
// -fno-semantic-interposition: GCC 12 then takes what chooses between the two for a function that
// never throws, and a std::bad_alloc out of either ends the process.
#pragma once

#include "base/sanitizer.h"

// Sanitizers cannot start with the indirect functions that this needs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(CREASE_ADDRESS_SANITIZER) && !defined(CREASE_THREAD_SANITIZER)
#define CREASE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define CREASE_WIDE
#endif

// CREASE_AVX2 before a function that is called only where has_avx2(): where what eight floats at
// once save is more than a branch, in functions that are templates or must be the same under
// sanitizers. Not defined where no processor has that.
#if defined(__x86_64__) && defined(__GNUC__)
#define CREASE_AVX2 __attribute__((target("avx2")))
namespace crease {
inline bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0;
}
}  // namespace crease
#endif
