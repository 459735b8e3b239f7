// Which blocks of a file a view needs: the criteria of AdaptiveMesh::update(), of whole blocks.
//
//   decode_model(file, {.wants = [&](const BlockEntry& entry) {
//     return needs_block(entry.facts, file.facts().grid, view);
//   }});
#pragma once

#include "crease/adaptive_mesh.h"
#include "crease/block_file.h"

namespace crease {

// Whether what the block stands for at its coarse end is seen to be wrong.
bool needs_block(const BlockFacts& block, const Grid& grid, const ViewParameters& view);

}  // namespace crease
