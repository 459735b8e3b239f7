// Logarithms and powers of two as every machine computes them, where std::log2 and std::exp2 differ
// from library to library. They are within 1 % of the true ones, which is enough to say how wide a
// distribution is.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace crease::codec {

// About log2(x), of a positive normal number.
inline float rough_log2(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const float exponent = static_cast<float>(static_cast<std::int32_t>(bits >> 23) - 127);
  const float t = std::bit_cast<float>((bits & ((1u << 23) - 1)) | 127u << 23) - 1;
  return exponent + t + 0.34f * t * (1 - t);
}

// About 2^x.
inline float rough_exp2(float x) {
  x = (x < -60 ? -60 : x < 60 ? x : 60) + 64;
  const std::int32_t whole = static_cast<std::int32_t>(x);
  const float t = x - static_cast<float>(whole);
  return std::bit_cast<float>((whole + (127 - 64)) << 23) * (1 + t - 0.34f * t * (1 - t));
}

}  // namespace crease::codec
