// Grid positions modulo 2^32: sums and differences that wrap instead of overflowing, so that what
// is taken away and added again is the same to the bit, wherever it was.
#pragma once

#include "crease/vec.h"

#include <cstdint>

namespace crease {

inline Vec3i grid_sum(const Vec3i& a, const Vec3i& b) {
  Vec3i sum;
  for (int i = 0; i < 3; ++i) {
    sum[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(a[i]) +
                                       static_cast<std::uint32_t>(b[i]));
  }
  return sum;
}

inline Vec3i grid_difference(const Vec3i& a, const Vec3i& b) {
  Vec3i difference;
  for (int i = 0; i < 3; ++i) {
    difference[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(a[i]) -
                                              static_cast<std::uint32_t>(b[i]));
  }
  return difference;
}

}  // namespace crease
