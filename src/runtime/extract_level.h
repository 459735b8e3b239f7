// A level of a linear progressive mesh as a mesh of its own.
#pragma once

#include "crease/mesh.h"
#include "hierarchy/linear_state.h"

namespace crease {

// Triangles in the order of their sections; used vertices and values only.
//
// Attribute ids: an index is an id of its own. What a slot owns has no index; it is the id of a
// corner at the same slot that has the same bits (the build sees to it that there is one at most),
// else of any corner with these bits. So the corners of a vertex share exactly what they shared in
// the input.
Mesh extract_level(const ProgressiveArrays& arrays, const LinearState& state);

}  // namespace crease
