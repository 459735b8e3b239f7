// DB03 phase III: the sequence followed a second time, now that every class is known, and written
// as packed contractions over rearranged arrays.
#pragma once

#include "assemble/restructure.h"
#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/progressive_arrays.h"

#include <cstdint>
#include <vector>

namespace crease {

// Where the input's triangles and vertices went: for tests and for tools that follow an element.
struct Arrangement {
  std::vector<std::uint32_t> new_of_triangle;
  std::vector<std::uint32_t> slot_of_vertex;  // at full resolution
};

// Uses up `parts`. `arrangement` may be null.
ProgressiveArrays arrange(const Mesh& snapped, const ContractionSequence& sequence,
                          Restructured parts, Arrangement* arrangement);

}  // namespace crease
