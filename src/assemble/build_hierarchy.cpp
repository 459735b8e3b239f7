// The passes that make a hierarchy, in order.
#include "crease/build_hierarchy.h"

#include "assemble/attribute_forest.h"
#include "assemble/bound_splits.h"
#include "assemble/inherit_values.h"
#include "assemble/introduce_triangles.h"
#include "assemble/join_roots.h"
#include "assemble/leaf_wedges.h"
#include "assemble/vertex_forest.h"
#include "mesh/clean.h"

#include <utility>
#include <vector>

namespace crease {

Result<MeshHierarchy> build_hierarchy(const Mesh& snapped, const ContractionSequence& sequence,
                                      const HierarchyOptions& options, HierarchyMaps* maps) {
  if (options.one_root) return build_hierarchy(snapped, join_roots(snapped, sequence), {}, maps);

  MeshHierarchy hierarchy;
  hierarchy.materials = snapped.materials;
  hierarchy.parts = snapped.parts;
  hierarchy.up = snapped.up;
  hierarchy.placement = sequence.placement;
  std::vector<Vec3i> leaf_positions;
  leaf_positions.reserve(snapped.vertex_count());
  for (const Vec3d& p : snapped.positions) leaf_positions.push_back(sequence.grid.nearest(p));

  const VertexForest forest = make_forest(leaf_positions, sequence.contractions);
  hierarchy.vertices = number_nodes(forest, leaf_positions, sequence);
  const LeafWedges wedges = find_wedges(snapped, forest, hierarchy.vertices);
  const TriangleTimes times =
      find_times(snapped, sequence, wedges.of_corner, hierarchy.vertices.wedge_count());
  std::vector<TriangleId> new_of_triangle =
      arrange_triangles(snapped, forest, wedges.of_corner, times, hierarchy.vertices);
  for (std::size_t l = 0; l < snapped.layers.size(); ++l) {
    Result<AttributeHierarchy> layer =
        grow_attributes({snapped, sequence, forest, wedges, times, hierarchy.vertices}, l);
    if (!layer.ok()) return layer.failure();
    hierarchy.layers.push_back(*std::move(layer));
  }
  bound_splits(snapped, leaf_positions, forest, hierarchy);
  for (AttributeHierarchy& layer : hierarchy.layers) inherit_values(hierarchy.vertices, layer);

  if (maps != nullptr) {
    maps->leaf_of_vertex.assign(forest.node_of_birth.begin(),
                                forest.node_of_birth.begin() + std::ptrdiff_t(forest.leaf_count));
    maps->new_of_triangle = std::move(new_of_triangle);
    maps->split_of_contraction = forest.split_of_contraction;
  }
  return hierarchy;
}

std::vector<char> triangles_facing_away(const Mesh& snapped, const HierarchyMaps& maps) {
  std::vector<char> faces_away(snapped.triangle_count(), 0);
  const AttributeLayer* const normals = snapped.normals();
  for (std::size_t t = 0; normals != nullptr && t < faces_away.size(); ++t) {
    faces_away[index_of(maps.new_of_triangle[t])] = has_reversed_normals(snapped, *normals, t);
  }
  return faces_away;
}

}  // namespace crease
