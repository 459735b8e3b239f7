// Where the blocks and the streets between them are, along one axis.
#pragma once

#include <cstdint>
#include <vector>

namespace crease {

inline constexpr int kLastBlock = 48;   // blocks are numbered from -48 to 48 along each axis
inline constexpr int kRiverAfter = -3;  // along y: between the blocks -3 and -2

struct StreetAxis {
  struct Block {
    double low, high;   // kerb to kerb
    bool avenue_after;  // the street up to the next block is a wide one
    double middle() const { return (low + high) / 2; }
  };
  std::vector<Block> blocks;

  const Block& at(int i) const { return blocks[std::size_t(i + kLastBlock)]; }
  double street_after(int i) const { return at(i + 1).low - at(i).high; }
};

struct StreetGrid {
  StreetAxis x, y;
  double river_low, river_high;  // along y, quay to quay
};

// The nine blocks in the middle together are 210 m by 180 m.
StreetGrid make_street_grid(std::uint64_t seed);

}  // namespace crease
