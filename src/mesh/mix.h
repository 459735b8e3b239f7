// A hash of 64 bits, for the flat tables that weld.
#pragma once

#include <cstdint>

namespace crease {

// The finaliser of splitmix64: every input bit reaches every output bit, so that the regular bit
// patterns of grids and millimetres do not pile up in a table. Of 0 it is 0.
inline std::uint64_t mix(std::uint64_t h) {
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return h ^ (h >> 31);
}

}  // namespace crease
