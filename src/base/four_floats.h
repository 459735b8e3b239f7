// Four floats at once, in one register: each result is what the same does to single ones.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace crease {

using FourFloats [[gnu::vector_size(16)]] = float;
using FourInts [[gnu::vector_size(16)]] = std::int32_t;

inline FourFloats root(const FourFloats& x) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(x);
#else
  return FourFloats{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}

// a where a is less, or greater, else b; so b where either is not a number.
inline FourFloats lesser(const FourFloats& a, const FourFloats& b) {
#if defined(__SSE2__)
  return _mm_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}
inline FourFloats greater(const FourFloats& a, const FourFloats& b) {
#if defined(__SSE2__)
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

// A bit for each lane that is negative, as those are for which a comparison holds.
inline std::uint32_t negative_lanes(const FourInts& x) {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(std::bit_cast<FourFloats>(x)));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= std::uint32_t(x[i] < 0) << i;
  return bits;
#endif
}

}  // namespace crease
