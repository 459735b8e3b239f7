// Small parts of a block that vanish do so in one go: see hierarchy/whole_part.h.
#pragma once

#include "codec/order_contractions.h"
#include "codec/unfold_blocks.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// From the contraction that breaks a part on, which vanishes in the block, those of the part follow
// each other at one cost. `vanished_of_split`: how many triangles go with each. `radian`: what one
// that a normal is off is worth beside a distance, grid units. Costs are ascending, before and
// after; children come before their parents. Time O(triangles + splits log splits).
void keep_parts_whole(const UnfoldedBlock& block, std::span<const std::uint32_t> vanished_of_split,
                      double radian, std::vector<OrderedContraction>& order);

}  // namespace crease::codec
