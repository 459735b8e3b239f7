// Virtual contractions on top of a sequence, until one vertex is left.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"

namespace crease {

// Near vertices go first, along a space-filling curve; v_s stays where the kept one is. Its errors
// are those of both, and its surface error their distance at least: a part disappears into another.
ContractionSequence join_roots(const Mesh& snapped, const ContractionSequence& sequence);

}  // namespace crease
