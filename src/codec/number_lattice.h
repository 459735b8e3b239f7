// Codes for one component of values that are no directions: texture coordinates, colours.
//
//   const NumberLattice lattice{.divisor = 255, .low = 0, .high = 255};
//   lattice.value(lattice.nearest(0.5019608f)) == 0.5019608f;     // 128 / 255, exactly
//
// A value is code / divisor, one correctly rounded quotient, so that it has the same bits
// everywhere. Powers of two give halves, quarters and the middles of texels; 255 and 65535 give
// what files in bytes hold. Or values are a few, in a table, and others evenly between two of them.
//
// Where the input's values are coarser than what is made of them should be, they are multiples of
// a grain: blends use all codes, and a file tells the input's by the grain, in few bits.
#pragma once

#include <cstdint>
#include <vector>

namespace crease {

// A file has no larger one.
inline constexpr std::int32_t kMostGrain = 1 << 16;

struct NumberLattice {
  float divisor = 1;               // value = float(code) / divisor; > 0
  std::int32_t low = 0, high = 0;  // codes, at most 2^24 from zero: exact as a float
  std::vector<float> palette;  // not empty: palette[i] is the value of low + i * grain; ascending
  std::int32_t grain = 1;      // low, high and all codes of the input are multiples; > 0

  float value(std::int32_t code) const;     // low <= code <= high
  std::int32_t nearest(float value) const;  // the nearest code in [low, high]; the lower of two
  bool operator==(const NumberLattice&) const = default;
};

}  // namespace crease
