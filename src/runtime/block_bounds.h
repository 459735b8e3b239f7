// How far off a block is at its coarse end, and where, as a view asks it (runtime/view_error.h).
#pragma once

#include "crease/block_file.h"
#include "crease/split_bounds.h"
#include "runtime/rounded_error.h"

namespace crease {

// A sphere, and how far what is in it may be off.
struct BlockBounds {
  SplitBounds bounds;
  Vec3f center;  // from the grid's origin, model units
};

inline BlockBounds bounds_of(const BlockFacts& block, const Grid& grid) {
  BlockBounds result;
  set_error(result.bounds, RoundedError::from(block.coarse));
  result.bounds.radius = RoundedUp::from(static_cast<float>(grid.step * block.radius));
  result.center = {static_cast<float>(grid.step * block.center.x),
                   static_cast<float>(grid.step * block.center.y),
                   static_cast<float>(grid.step * block.center.z)};
  return result;
}

}  // namespace crease
