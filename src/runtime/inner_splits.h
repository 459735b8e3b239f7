// What a block shows may be coarser than its coarse end inside of its patch: the splits of the next
// coarser blocks that touch no triangle of another patch can be undone, and nobody beside it sees.
//
// Where few vertices of a block are wrong, most of its coarse end is finer than a view needs. On a
// flight over a city of 4 M triangles levels that had all of it drew 1.57 times what by vertex
// does; with inner splits undone it is 1.29 times.
#pragma once

#include "codec/block_end.h"
#include "codec/unfold_blocks.h"
#include "runtime/resident_block.h"

#include <span>

namespace crease {

// As a block of its own, whose fine end is `start`, the coarse end of the block with such `facts`;
// it has no values at its coarse end. Slots and numbers are those of `start`. `needed`: as for
// coarse_end_of().
codec::UnfoldedBlock inner_splits_of(const BlockFacts& facts,
                                     std::span<const ResidentBlockPtr> needed,
                                     const codec::CoarseEnd& start);

}  // namespace crease
