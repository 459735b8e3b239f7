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

// The same in doubles, in two halves.
struct FourDoubles {
  using Half [[gnu::vector_size(16)]] = double;
  Half low, high;

  static FourDoubles from(const FourInts& x) {
#if defined(__SSE2__)
    const auto ints = std::bit_cast<__m128i>(x);
    return {_mm_cvtepi32_pd(ints), _mm_cvtepi32_pd(_mm_unpackhi_epi64(ints, ints))};
#else
    return {{double(x[0]), double(x[1])}, {double(x[2]), double(x[3])}};
#endif
  }
  FourFloats rounded() const {
#if defined(__SSE2__)
    return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
#else
    return {float(low[0]), float(low[1]), float(high[0]), float(high[1])};
#endif
  }
  FourDoubles operator+(const FourDoubles& o) const {
    return {low + o.low, high + o.high};
  }
  FourDoubles operator*(const FourDoubles& o) const {
    return {low * o.low, high * o.high};
  }
  FourDoubles operator/(const FourDoubles& o) const {
    return {low / o.low, high / o.high};
  }
};

inline FourDoubles root(const FourDoubles& x) {
#if defined(__SSE2__)
  return {_mm_sqrt_pd(x.low), _mm_sqrt_pd(x.high)};
#else
  return {{std::sqrt(x.low[0]), std::sqrt(x.low[1])}, {std::sqrt(x.high[0]), std::sqrt(x.high[1])}};
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
