// One block as a vertex hierarchy of its own: roots are the vertices of its coarse end, leaves
// those of its fine end.
#pragma once

#include "codec/patch_mesh.h"
#include "crease/block_mesh.h"
#include "crease/mesh_hierarchy.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

struct BlockHierarchy::Data {
  BlockId id{};
  bool is_empty = false;  // the block has none
  MeshHierarchy hierarchy;
  // Per vertex of the fine end, by its number there.
  std::vector<NodeId> leaf_of_vertex;
  std::vector<std::uint32_t> wedge_of_vertex;  // the first one; kNone: no triangle has it
  // Per root; root r is vertex r until it is split.
  std::vector<NodeId> node_of_root;
  // Per triangle of the fine end: under which roots its corners are, and which one it is in the
  // hierarchy. The first ones are those of the coarse end.
  std::vector<codec::Corners> roots_of_triangle;
  std::vector<std::uint32_t> triangle_of;  // per triangle of the hierarchy: of the fine end
  std::size_t bytes = 0;
};

}  // namespace crease
