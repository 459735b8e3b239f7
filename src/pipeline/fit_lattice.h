// The lattice for one component of a layer, from its values.
//
//   const NumberLattice lattice = fit_lattice(component, 8, 6);
//
// The first of these that fits:
// (1) every value is a multiple of a power of two, or k / 255 and the like (what a file in bytes
//     holds), in not much more than 2^bits steps: that, exactly;
// (2) there are few distinct values: their table;
// (3) multiples of the largest power of two that divides the range in 2^bits steps or more. So 0,
//     1/2 and 1 stay, and the middles of texels, as the grid of positions keeps whole millimetres.
//
// Where that is coarse, as on a regular grid of texture coordinates, it is kept in grains, and its
// codes are about 2^blend_bits: what simplification blends goes where the surface goes, while a
// blend that is one of the input's values wavers.
#pragma once

#include "codec/number_lattice.h"

#include <span>

namespace crease {

inline constexpr int kMaxAskedBits = 16, kMaxLatticeBits = 24;

// `values` finite; bits from 1 to kMaxLatticeBits; blend_bits at most bits, 0 for no grain. Time
// O(n log n), or O(n) in case (1).
NumberLattice fit_lattice(std::span<const float> values, int bits, int blend_bits = 0);

}  // namespace crease
