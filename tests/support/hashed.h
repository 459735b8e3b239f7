// Numbers that look random and are the same everywhere.
#pragma once

#include <cstdint>

namespace crease {

// 0 to 1.
inline double hashed(std::uint32_t x) {
  x = (x + 1) * 2654435761u;
  return ((x ^ x >> 15) >> 8 & 0xffff) * 0x1p-16;
}

}  // namespace crease
