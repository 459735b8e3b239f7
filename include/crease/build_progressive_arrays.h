// Mesh + ContractionSequence -> ProgressiveArrays: DB03's phases I and III.
//
//   ProgressiveMesh levels(build_progressive_arrays(model.mesh, model.sequence));
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/progressive_arrays.h"

namespace crease {

// Partitions `snapped` and packs the contractions. `sequence` must hold check_contractions(). Time
// near linear.
ProgressiveArraysPtr build_progressive_arrays(const Mesh& snapped,
                                              const ContractionSequence& sequence);

}  // namespace crease
