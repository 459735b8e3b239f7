// A file tells the attributes at a vertex apart by their values. So must a sequence before it is
// written: where two that stand at one vertex become equal, one keeps the value that it had; where
// they were equal before, they are one from there on.
//
//   snap_new_values(sequence, mesh, codings);
//   join_equal_values(sequence, mesh);
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"

namespace crease {

// Rewrites the attribute changes. Levels look the same, but where two equal ones would have parted
// again: both go on as the first. The mesh's own must be joined (snap_to_codings()). Time as
// apply_contractions().
void join_equal_values(ContractionSequence& sequence, const Mesh& snapped);

}  // namespace crease
