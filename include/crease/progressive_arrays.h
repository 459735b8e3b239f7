// DB03's result as plain arrays: what a file holds and ProgressiveMesh moves in.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crease {

struct ProgressiveArrays {
  Grid grid;
  Placement placement = Placement::Optimal;
};
using ProgressiveArraysPtr = std::shared_ptr<const ProgressiveArrays>;

// Run-time bytes of the arrays at full resolution: DB03's claim in numbers. Each counts positions,
// indices and normals as a renderer needs them (12 bytes a position, 12 a normal, 4 an index), and,
// apart, the records that switch levels.
struct LinearBytes {
  std::size_t crease = 0;      // section 5: positions once, normals by kind
  std::size_t wedge = 0;       // Hoppe 1998: faces -> wedges -> vertices
  std::size_t replicated = 0;  // a vertex for every (position, normal) pair, one index buffer
  std::size_t records = 0;     // packed contractions, corner changes, deltas
};
LinearBytes linear_bytes(const ProgressiveArrays& arrays);

}  // namespace crease
