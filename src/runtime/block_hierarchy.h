// One block as a vertex hierarchy of its own: roots are the vertices of its coarse end, leaves
// those of its fine end. For levels, which may be coarser inside of the block, also with its inner
// splits (runtime/inner_splits.h) above the vertices of its coarse end.
#pragma once

#include "codec/patch_mesh.h"
#include "crease/block_mesh.h"
#include "crease/mesh_hierarchy.h"
#include "crease/packed_indices.h"
#include "runtime/rounded_error.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct BlockHierarchy::Data {
  BlockId id{};
  bool is_empty = false;    // the block has none
  LevelError coarse, fine;  // the largest at its ends
  LevelError coarser;       // of the blocks with its inner splits, at their coarse ends
  MeshHierarchy hierarchy;
  // Per split: what it adds to the errors that its vertex has at the fine end (BlockErrors).
  std::vector<RoundedError> own_errors;
  // Per vertex of the fine end, by its number there.
  std::vector<NodeId> leaf_of_vertex;
  std::vector<std::uint32_t> wedge_of_vertex;  // the first one; kNone: no triangle has it
  std::vector<char> is_inner;                  // per split; or empty: none is
  // Per vertex of the coarse end, a root unless inner splits are above it; root r is vertex r until
  // it is split.
  std::vector<NodeId> node_of_root;
  std::vector<std::uint32_t> triangle_of;  // per triangle of the hierarchy: of the fine end
  // What follows is of cuts by vertex, and not there for levels.
  std::vector<std::uint32_t> root_of_split;  // per split of a root; these are the first ones
  // Per triangle of the fine end, of which the first ones are those of the coarse end: under which
  // roots its corners are, and which one it is in the hierarchy.
  std::vector<codec::Corners> roots_of_triangle;
  std::vector<TriangleId> id_of_triangle;
  // Those of the coarse end at each root, root after root, and the roots that it shares a triangle
  // of the fine end with, itself among them if it has any.
  std::vector<std::uint32_t> first_triangle_of_root, first_in_ring;  // and the end
  PackedIndices<> triangles_of_root, rings;
  // Triangles of the fine end by the patch that goes on with them, as ResidentBlock::groups().
  std::vector<std::uint32_t> triangles_by_patch;
  std::uint32_t coarse_triangles = 0;
  bool shows_roots = false;  // with nothing split it has triangles that no coarser block has
  std::uint32_t requirable_splits = 0;  // those above leaves that triangles have
  std::size_t bytes = 0;

  bool is_inner_split(SplitId s) const {
    return s != kNoSplit && !is_inner.empty() && is_inner[index_of(s)] != 0;
  }
};

// As BlockHierarchyJob::run(), with inner splits.
BlockHierarchyPtr make_tall_hierarchy(const ResidentBlock& block,
                                      std::span<const ResidentBlockPtr> needed);

}  // namespace crease
