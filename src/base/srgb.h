// The transfer function of sRGB, IEC 61966-2-1. Files of pictures and of points have encoded
// values, glTF and light have linear ones.
#pragma once

#include <cmath>

namespace crease {

// Above 1 they go on, what is below 0 stays on the line, and 1 is 1.
inline float linear_from_srgb(float encoded) {
  const double e = double(encoded);
  return static_cast<float>(e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4));
}
inline float srgb_from_linear(float linear) {
  const double l = double(linear);
  return static_cast<float>(l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055);
}

}  // namespace crease
