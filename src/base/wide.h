// CREASE_WIDE before a function: it is compiled twice, and the wider one is taken where the
// processor has it. No products are fused, so both give the same to the bit.
#pragma once

// Sanitizers cannot start with the indirect functions that this needs.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CREASE_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define CREASE_WIDE
#endif
