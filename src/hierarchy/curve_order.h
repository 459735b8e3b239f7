// Grid positions in the order of a Morton curve: what is near in the order is near in space.
#pragma once

#include "crease/vec.h"

#include <cstdint>

namespace crease {

// Decided by the highest bit in which a coordinate differs, so no bit is lost and nothing is made.
inline bool is_before_on_curve(const Vec3i& a, const Vec3i& b) {
  constexpr std::uint32_t kSign = 0x80000000u;
  std::uint32_t most = 0;
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t change =
        static_cast<std::uint32_t>(a[i]) ^ static_cast<std::uint32_t>(b[i]);
    if (most >= change || most >= (most ^ change)) continue;  // no higher bit
    most = change;
    axis = i;
  }
  return (static_cast<std::uint32_t>(a[axis]) ^ kSign) <
         (static_cast<std::uint32_t>(b[axis]) ^ kSign);
}

}  // namespace crease
