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
