// The values of a layer for keeping: each once, and numbers. A third of the memory, where triangles
// share values.
#pragma once

#include "codec/patch_mesh.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

struct CompactValues {
  std::vector<CodedValue> values;        // all different
  std::vector<std::uint32_t> of_corner;  // which of them

  const CodedValue& at(std::size_t corner) const { return values[of_corner[corner]]; }
};

inline CompactValues compacted(std::span<const CodedValue> of_corner) {
  constexpr std::uint32_t kFree = 0xffffffffu;
  CompactValues result;
  result.of_corner.reserve(of_corner.size());
  std::vector<std::uint32_t> table(std::bit_ceil(2 * of_corner.size() + 1), kFree);
  for (const CodedValue& value : of_corner) {
    std::uint64_t hash = 0;
    for (const std::int32_t c : value) {
      hash = (hash ^ static_cast<std::uint32_t>(c)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    std::size_t place = hash & (table.size() - 1);
    while (table[place] != kFree && result.values[table[place]] != value) {
      place = (place + 1) & (table.size() - 1);
    }
    if (table[place] == kFree) {
      table[place] = static_cast<std::uint32_t>(result.values.size());
      result.values.push_back(value);
    }
    result.of_corner.push_back(table[place]);
  }
  result.values.shrink_to_fit();
  return result;
}

}  // namespace crease::codec
