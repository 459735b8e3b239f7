// Regions of one material in another, windows in a wall, that vanish in a block do so in one go, as
// in the simplifier: see hierarchy/island.h.
#pragma once

#include "codec/order_contractions.h"
#include "codec/unfold_blocks.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// Of a small region all of which vanishes in the block, the contractions that cost about as much as
// its dearest wait for that one. `split_of_vanished`: per triangle of the fine end the split that
// it goes with, or kNone. Costs are ascending, before and after; children come before their
// parents. Time O(triangles + splits log splits).
void keep_islands_whole(const UnfoldedBlock& block,
                        std::span<const std::uint32_t> split_of_vanished,
                        std::vector<OrderedContraction>& order);

}  // namespace crease::codec
