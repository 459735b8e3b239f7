// Logarithms and powers of two as every machine computes them: a polynomial between the powers,
// where std::log2 and std::exp2 differ from library to library. Within 1 % of the true ones, which
// is enough to say how wide a distribution is.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace crease::codec {

// About log2(x), of a positive normal number.
inline double rough_log2(double x) {
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const double exponent = static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  const std::uint64_t one = std::uint64_t(1023) << 52;
  const double t = std::bit_cast<double>((bits & ((std::uint64_t(1) << 52) - 1)) | one) - 1;
  return exponent + t + 0.34 * t * (1 - t);
}

// About 2^x.
inline double rough_exp2(double x) {
  x = std::clamp(x, -60.0, 60.0) + 64;
  const std::int64_t whole = static_cast<std::int64_t>(x);
  const double t = x - static_cast<double>(whole);
  return std::bit_cast<double>(static_cast<std::uint64_t>(whole - 64 + 1023) << 52) *
         (1 + t - 0.34 * t * (1 - t));
}

}  // namespace crease::codec
