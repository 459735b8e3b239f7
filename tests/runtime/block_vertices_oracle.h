// What a BlockMesh should show by vertex, or between its blocks' ends, by the definition: every
// triangle of the refined blocks with the active ancestors of its corners, kept where the three
// differ. Which splits are done is read from the mesh; nothing else of it is used.
#pragma once

#include "crease/block_mesh.h"

namespace crease {

// What is shown is that, as a mesh and as triangles to draw.
void check_by_vertex(const BlockMesh& mesh);

// By block: no vertex that a level leaves as it is is seen to be wrong, as the blocks of the cut
// tell. Returns how many blocks are between their ends.
std::size_t check_levels_are_right(const BlockMesh& mesh, const ViewParameters& view);

// Nothing that could be split in a block that is by vertex is seen to be wrong. Returns how many
// blocks are.
std::size_t check_nothing_is_wrong(const BlockMesh& mesh, const ViewParameters& view);

}  // namespace crease
