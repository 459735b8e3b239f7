// Numbers in an order that has nothing to do with that of what they are made from: to choose some
// of many without following how a mesh numbers its triangles.
#pragma once

#include <cstdint>

namespace crease {

// One to one.
inline std::uint32_t mixed(std::uint32_t x) {
  x *= 0x9e3779b1u;
  return (x ^ x >> 15) * 0x85ebca77u;
}

}  // namespace crease
