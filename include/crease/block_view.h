// Which blocks of a file a view needs: the criteria of AdaptiveMesh::update(), of whole blocks.
//
//   decode_model(file, {.wants = [&](const BlockEntry& entry) {
//     return needs_block(entry.facts, file.facts().grid, view);
//   }});
#pragma once

#include "crease/adaptive_mesh.h"
#include "crease/block_file.h"
#include "crease/block_mesh.h"

#include <functional>
#include <span>
#include <vector>

namespace crease {

// Whether what the block stands for at its coarse end is seen to be wrong.
bool needs_block(const BlockFacts& block, const Grid& grid, const ViewParameters& view);

// What a frame needs to draw: a cut by block reaches far beyond the view, since whole blocks are
// refined. The groups of what is shown that `is_in` holds for, consecutive ones joined. Time
// O(groups).
std::vector<ShownRange> shown_groups(std::span<const ShownRange> shown,
                                     const std::function<bool(const BlockGroup&)>& is_in);
// The same of a cut that has groups: ranges of its list, with its block. Of any other, all of it.
std::vector<ShownRange> shown_groups(const ShownCut& cut,
                                     const std::function<bool(const BlockGroup&)>& is_in);
// Those whose boxes are not beside the camera's view or behind it. `origin`: of the draw lists.
std::vector<ShownRange> shown_in_view(std::span<const ShownRange> shown, const Vec3d& origin,
                                      const Camera& camera);
std::vector<ShownRange> shown_in_view(const ShownCut& cut, const Camera& camera);

}  // namespace crease
