// Mesh + ContractionSequence -> MeshHierarchy.
//
//   Result<MeshHierarchy> hierarchy = build_hierarchy(snapped, sequence, {});
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/mesh_hierarchy.h"
#include "crease/result.h"

#include <vector>

namespace crease {

struct HierarchyOptions {
  // Joins what the sequence leaves under one root, near things first. Nothing is shown by these
  // joins that is worth seeing: their error is how far what they join is moved.
  bool one_root = false;
};

// Where things of the input are in the hierarchy.
struct HierarchyMaps {
  std::vector<NodeId> leaf_of_vertex;
  std::vector<TriangleId> new_of_triangle;  // corners keep their order
  std::vector<SplitId> split_of_contraction;
};

// `sequence` must hold check_contractions(). v_t of a split is the contraction's kept vertex, v_u
// the removed one. Fails only where a vertex has more than 65,534 attributes of a layer. Time near
// linear in input and result, whose every node has its own attributes: a hub of thousands that is
// contracted again and again has them again each time. Memory beside input and result about 100
// bytes a triangle. `maps` may be null.
Result<MeshHierarchy> build_hierarchy(const Mesh& snapped, const ContractionSequence& sequence,
                                      const HierarchyOptions& options,
                                      HierarchyMaps* maps = nullptr);

// Per triangle of the hierarchy: 1 where all its corners' normals are on the other side than its
// winding has outside. Cuts are no more folded there than the input (AdaptiveMesh::unfold).
std::vector<char> triangles_facing_away(const Mesh& snapped, const HierarchyMaps& maps);

// Whether full refinement is `snapped`, corner for corner: positions, values, materials and parts,
// and which corners of a vertex share an attribute. `hierarchy` must hold check_hierarchy(). Time
// O(corners * depth).
Status check_leaves(const MeshHierarchy& hierarchy, const HierarchyMaps& maps, const Mesh& snapped);

}  // namespace crease
