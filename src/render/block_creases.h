// Crease lines of a block, and which of them a cut shows.
//
//   const BlockCreases own = creases_of(*block);                  // once
//   std::vector<std::span<const RimEdge>> rims;
//   for (const ShownRange& run : mesh.shown()) draw(own.hard, hard_of_run(run, own, rims));
//   draw(join_rims(rims));
#pragma once

#include "crease/block_mesh.h"
#include "render/crease_lines.h"

#include <span>
#include <vector>

namespace crease {

// Per group of the block, in their order.
struct BlockCreases {
  std::vector<Line3f> hard;          // group by group
  std::vector<Range> hard_of_group;  // lines
  std::vector<std::vector<RimEdge>> rim_of_group;
};

BlockCreases creases_of(const ResidentBlock& block);

// The lines of a run of groups, which follow each other. Adds the groups' rims to `rims`.
Range hard_of_run(const ShownRange& run, const BlockCreases& block,
                  std::vector<std::span<const RimEdge>>& rims);

}  // namespace crease
