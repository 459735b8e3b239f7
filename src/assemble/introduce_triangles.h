// When triangles and their corners come to an end, in terms of contractions.
#pragma once

#include "assemble/leaf_wedges.h"
#include "assemble/vertex_forest.h"
#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/mesh_hierarchy.h"

#include <cstdint>
#include <vector>

namespace crease {

// A time is a contraction, or kNever; what ends at i is there in every state before contraction i.
struct TriangleTimes {
  // Per triangle: the contraction that collapses it.
  std::vector<std::uint32_t> collapsed;
  // Per triangle: from here on it shows its geometric normal.
  std::vector<std::uint32_t> derived;
  // Per wedge: until some ancestor has two corners of each of its triangles below. Until then a cut
  // exists that shows the wedge at the ancestor (liveness).
  std::vector<std::uint32_t> wedge_live_until;
  // Per wedge: until the linear levels show it no more, as a normal or as another attribute.
  std::vector<std::uint32_t> normal_shown_until, wedge_shown_until;
};

// Time O(triangles * log(vertices)).
TriangleTimes find_times(const Mesh& snapped, const ContractionSequence& sequence,
                         const std::vector<WedgeId>& wedge_of_corner, std::size_t wedge_count);

// Puts the triangles in the order of their splits; fills what the hierarchy says of triangles.
// Returns the new number of each.
std::vector<TriangleId> arrange_triangles(const Mesh& snapped, const VertexForest& forest,
                                          const std::vector<WedgeId>& wedge_of_corner,
                                          const TriangleTimes& times, VertexHierarchy& hierarchy);

}  // namespace crease
