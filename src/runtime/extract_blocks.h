// What a BlockMesh shows as a mesh of its own.
#pragma once

#include "runtime/block_mesh_impl.h"

namespace crease {

Mesh extract_blocks(const BlockMesh::Impl& mesh);

}  // namespace crease
