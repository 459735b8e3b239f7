// Which contractions of a block have to wait, since they would fold a triangle over as things are.
#pragma once

#include "codec/order_contractions.h"
#include "codec/unfold_blocks.h"

#include <vector>

namespace crease::codec {

// Undoes the block's splits in this order. One that folds a triangle over, or leaves it without
// area, goes after those that cost as much as the fold, as in the simplifier: by then what lies
// around has mostly changed and nothing folds. Where something still does it waits twice more,
// until others cost twice as much. Its parents wait with it. Costs are still ascending then. Time
// O(splits * triangles around a vertex).
std::vector<OrderedContraction> defer_folds(const UnfoldedBlock& block,
                                            std::vector<OrderedContraction> order);

}  // namespace crease::codec
