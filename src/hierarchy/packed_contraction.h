// The header word of a packed contraction and the groups of its block.
//
//   bit 0       the removed slot is NSN        bits 6-7    SN vertices lost
//   bit 1       positions swap                 bits 8-9    NSN vertices lost
//   bit 2       the own normal changes         bits 10-13  SN triangles lost
//   bit 3       other own values change        bits 14-17  FN triangles lost
//   bit 4       it has a block                 bits 18-21  NSN triangles lost
//   bit 5       counts are in `wide`           bits 22-31  corner changes
//
// A group of a block is one word, kind (bits 0-1), layer (2-15) and count (16-31), then its items.
#pragma once

#include "crease/progressive_arrays.h"

#include <algorithm>
#include <cstdint>

namespace crease {

struct PackedHeader {
  bool removed_is_nsn = false;
  bool swaps_positions = false;
  bool own_normal_changes = false;
  bool own_values_change = false;
  bool has_block = false;
  bool is_wide = false;
  SectionCounts lost;  // the removed vertex included. Zero when wide
  std::uint32_t corner_changes = 0;
};

inline PackedHeader unpack_header(std::uint32_t word) {
  const auto bits = [word](int first, int count) { return word >> first & ((1u << count) - 1); };
  PackedHeader h;
  h.removed_is_nsn = bits(0, 1) != 0;
  h.swaps_positions = bits(1, 1) != 0;
  h.own_normal_changes = bits(2, 1) != 0;
  h.own_values_change = bits(3, 1) != 0;
  h.has_block = bits(4, 1) != 0;
  h.is_wide = bits(5, 1) != 0;
  h.lost = {bits(6, 2), bits(8, 2), bits(10, 4), bits(14, 4), bits(18, 4)};
  h.corner_changes = bits(22, 10);
  return h;
}

// Counts that do not fit set is_wide and are left out.
inline std::uint32_t pack_header(PackedHeader& h) {
  const SectionCounts& lost = h.lost;
  h.is_wide = std::max(lost.sn_vertices, lost.nsn_vertices) > 3 ||
              std::max({lost.sn_triangles, lost.fn_triangles, lost.nsn_triangles}) > 15 ||
              h.corner_changes > 1023;
  std::uint32_t word = (h.removed_is_nsn ? 1u : 0u) | (h.swaps_positions ? 2u : 0u) |
                       (h.own_normal_changes ? 4u : 0u) | (h.own_values_change ? 8u : 0u) |
                       (h.has_block ? 16u : 0u) | (h.is_wide ? 32u : 0u);
  if (h.is_wide) return word;
  return word | lost.sn_vertices << 6 | lost.nsn_vertices << 8 | lost.sn_triangles << 10 |
         lost.fn_triangles << 14 | lost.nsn_triangles << 18 | h.corner_changes << 22;
}

enum class BlockKind : std::uint8_t {
  Indices,  // items of two words: corner, xor of the value indices before and after
  Derived,  // items: triangle that becomes derived
  Touched,  // items: corner at the kept slot
};

struct PackedGroup {
  BlockKind kind{};
  std::uint32_t layer = 0;  // 0: normals; l + 1: ProgressiveArrays::layers[l]
  std::uint32_t count = 0;
};
inline constexpr std::uint32_t kMaxGroupCount = 0xffff;
inline constexpr std::uint32_t kMaxLayers = 0x3fff;

inline PackedGroup unpack_group(std::uint32_t word) {
  return {static_cast<BlockKind>(word & 3), word >> 2 & kMaxLayers, word >> 16};
}
inline std::uint32_t pack_group(const PackedGroup& g) {
  return static_cast<std::uint32_t>(g.kind) | g.layer << 2 | g.count << 16;
}

// Words of one change of the other layers' own values.
inline std::size_t own_value_words(const ProgressiveArrays& arrays) {
  std::size_t words = 0;
  for (const ProgressiveLayer& layer : arrays.layers) {
    if (layer.storage == ProgressiveLayer::Storage::Vertex) words += layer.dimension;
  }
  return words;
}

}  // namespace crease
