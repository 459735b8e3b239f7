// Logarithms, powers of two and angles as every machine computes them, where std::log2, std::exp2
// and std::atan2 differ from library to library. The first two are within 1 % of the true ones,
// which is enough to say how wide a distribution is.
#pragma once

#include <algorithm>
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

// The angle whose sine and cosine are as y, not below zero, to x: in radians, within 0.00002.
inline double rough_angle(double y, double x) {
  const double width = std::abs(x), most = std::max(y, width);
  if (!(most > 0)) return 0;
  const double t = std::min(y, width) / most, s = t * t;
  double angle =
      t * (0.999866 + s * (-0.3302995 + s * (0.180141 + s * (-0.085133 + s * 0.0208351))));
  if (y > width) angle = 1.5707963267948966 - angle;
  return x < 0 ? 3.141592653589793 - angle : angle;
}

}  // namespace crease::codec
