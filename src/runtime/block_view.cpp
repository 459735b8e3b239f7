#include "crease/block_view.h"

#include "runtime/block_bounds.h"
#include "runtime/view_error.h"

namespace crease {

bool needs_block(const BlockFacts& block, const Grid& grid, const ViewParameters& view) {
  const BlockBounds own = bounds_of(block, grid);
  return ViewError(view, grid).of(own.bounds, own.center) > 1;
}

}  // namespace crease
