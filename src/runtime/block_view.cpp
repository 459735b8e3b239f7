#include "crease/block_view.h"

#include "runtime/view_error.h"

#include <limits>

namespace crease {

bool needs_block(const BlockFacts& block, const Grid& grid, const ViewParameters& view) {
  SplitBounds bounds;
  bounds.surface = RoundedUp::from(block.coarse.surface);
  bounds.line = RoundedUp::from(block.coarse.line);
  bounds.degrees = RoundedUp::from(block.coarse.degrees);
  bounds.texture = RoundedUp::from(block.coarse.texture);
  bounds.radius = RoundedUp::from(static_cast<float>(grid.step * block.radius));
  const ViewError error(view, grid);
  return error.of(bounds, error.position(block.center)) > 1;
}

}  // namespace crease
