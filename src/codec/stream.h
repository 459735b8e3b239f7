// What the bits of a block are about.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace crease::codec {

enum class Stream : std::uint8_t {
  Roots,   // vertices and triangles that come from nowhere
  Flags,   // which vertices are split
  Shapes,  // which triangles a split introduces and moves
  Positions,
  Categories,  // materials, parts, derived triangles
  Values,      // of attributes
  Labels,      // patches of the next finer band
  Count,
};

using StreamBits = std::array<double, std::size_t(Stream::Count)>;

}  // namespace crease::codec
