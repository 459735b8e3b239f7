// A file tells the attributes at a vertex apart by their values. So must a sequence before it is
// written: where codes make two equal that the sequence has apart, one of them, with all that
// becomes one with it, keeps a value that it had, or gets a code beside. Else a hard edge would be
// shaded across by chance. One from there on are those that nothing tells apart: what is flat and
// was equal at both ends, and values other than directions where all that they had is taken.
//
//   snap_new_values(sequence, mesh, codings);
//   join_equal_values(sequence, mesh, codings);
#pragma once

#include "codec/layer_coding.h"
#include "crease/contraction.h"
#include "crease/mesh.h"

#include <span>

namespace crease {

// Rewrites the attribute changes, and adds values. The mesh's own must be joined, and the
// sequence's snapped to `codings`. Time as apply_contractions().
void join_equal_values(ContractionSequence& sequence, const Mesh& snapped,
                       std::span<const LayerCoding> codings);

}  // namespace crease
