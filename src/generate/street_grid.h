// Where the blocks and the streets between them are, along one axis.
#pragma once

#include <cstdint>
#include <vector>

namespace crease {

inline constexpr int kRiverAfter = -3;  // along y: between the blocks -3 and -2

// Blocks up to here, either way, are where they are however many there are beyond.
inline constexpr int kLastInnerBlock = 48;

struct StreetAxis {
  struct Block {
    double low, high;   // kerb to kerb
    bool avenue_after;  // the street up to the next block is a wide one
    double middle() const { return (low + high) / 2; }
  };
  std::vector<Block> blocks;  // from -last to last
  int last = 0;

  const Block& at(int i) const { return blocks[std::size_t(i + last)]; }
  double street_after(int i) const { return at(i + 1).low - at(i).high; }
};

struct StreetGrid {
  StreetAxis x, y;
  double river_low, river_high;  // along y, quay to quay
};

// The nine blocks in the middle together are 210 m by 180 m. `last`: kLastInnerBlock or more.
StreetGrid make_street_grid(std::uint64_t seed, int last);

}  // namespace crease
