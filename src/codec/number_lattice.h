// Codes for one component of values that are no directions: texture coordinates, colours.
//
//   const NumberLattice lattice{.divisor = 255, .low = 0, .high = 255};
//   lattice.value(lattice.nearest(0.5019608f)) == 0.5019608f;     // 128 / 255, exactly
//
// A value is code / divisor, one correctly rounded quotient, so that it has the same bits
// everywhere. Powers of two give halves, quarters and the middles of texels; 255 and 65535 give
// what files in bytes hold. Or a value is one of a few, in a table.
#pragma once

#include <cstdint>
#include <vector>

namespace crease {

struct NumberLattice {
  float divisor = 1;               // value = float(code) / divisor; > 0
  std::int32_t low = 0, high = 0;  // codes, at most 2^24 from zero: exact as a float
  std::vector<float> palette;      // not empty: value = palette[code - low], ascending

  float value(std::int32_t code) const;     // low <= code <= high
  std::int32_t nearest(float value) const;  // the nearest code in [low, high]; the lower of two
  bool operator==(const NumberLattice&) const = default;
};

}  // namespace crease
