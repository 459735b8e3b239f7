// The grid that a model's numbers are on already: whole millimetres, six decimals, sixteenths, or
// what a quantized or compressed file has left of them.
#pragma once

#include "crease/mesh.h"

#include <optional>
#include <span>

namespace crease {

// The longest step, from `longest` down to `shortest`, both above 0, of which all coordinates are
// multiples, as floats if they all are floats: one, two or five of a power of ten, or a power of
// two. Time O(positions), and far less where there is none.
std::optional<double> round_step(std::span<const Vec3d> positions, double longest, double shortest);

// The grid of that, or one on which coordinates are whole steps apart along each axis, within a
// float's rounding, if they are many. The origin is some point of it. Time O(n log n) in positions.
std::optional<Grid> own_grid(std::span<const Vec3d> positions, double longest, double shortest);

}  // namespace crease
