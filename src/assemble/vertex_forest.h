// The binary forest of all contractions, and the numbers of its nodes in a VertexHierarchy.
//
// Here vertices go by their birth: the input vertices 0 .. n-1, then v_s of contraction i as n + i.
// So children are born before their parents, and times are contractions.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh_hierarchy.h"

#include <array>
#include <cstdint>
#include <vector>

namespace crease {

struct VertexForest {
  std::uint32_t leaf_count = 0;
  std::uint32_t root_count = 0;
  std::vector<std::array<std::uint32_t, 2>> children;  // per contraction: births of v_t and v_u
  std::vector<NodeId> node_of_birth;
  std::vector<std::uint32_t> birth_of_node;

  std::size_t contraction_count() const { return children.size(); }
  bool is_leaf(std::uint32_t birth) const { return birth < leaf_count; }
  // The split of a contraction: contractions and splits run in different orders.
  std::vector<SplitId> split_of_contraction;
  std::vector<std::uint32_t> contraction_of_split;
  // Subtree after subtree, children first: what a pass reads was written a moment ago. The sequence
  // itself jumps from patch to patch (2.9 million triangles: 9.2 s in its order, 5.7 in this).
  std::vector<std::uint32_t> from_left_to_right;
};

// Roots are numbered along a curve through space, and with them all that is below them: what a view
// needs next is near in memory, and a WatchList looks at neighbours together.
VertexForest make_forest(const std::vector<Vec3i>& leaf_positions,
                         const std::vector<Contraction>& contractions);

// Roots, splits, positions and errors. Wedges, triangles, radii and cones come later.
VertexHierarchy number_nodes(const VertexForest& forest, const std::vector<Vec3i>& leaf_positions,
                             const ContractionSequence& sequence);

// The first wedge under every leaf, for so many wedges of each leaf; fills root_wedges and
// second_wedge.
std::vector<std::uint32_t> number_wedges(const VertexForest& forest,
                                         const std::vector<std::uint32_t>& wedge_count_of_leaf,
                                         VertexHierarchy& hierarchy);

}  // namespace crease
