#include "assemble/bound_splits.h"

#include "hierarchy/geometric_normal.h"
#include "hierarchy/normal_cone.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

struct Extent {
  double radius = 0;  // model units
  GrowingCone cone;
};

// A float is rounded to the nearest by itself.
RoundedUp rounded_up(double value) {
  float rounded = static_cast<float>(value);
  if (double(rounded) < value) rounded = std::nextafter(rounded, HUGE_VALF);
  return RoundedUp::from(rounded);
}

Vec3d as_double(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

std::vector<Extent> extents_of_leaves(const Mesh& snapped, const std::vector<Vec3i>& positions,
                                      double step) {
  std::vector<Extent> extents(snapped.vertex_count());
  for (const Triangle& t : snapped.triangles) {
    const Vec3i p[3] = {positions[index_of(t[0])], positions[index_of(t[1])],
                        positions[index_of(t[2])]};
    const Vec3f n = geometric_normal(p[0], p[1], p[2]);
    const GrowingCone cone = GrowingCone::of({double(n.x), double(n.y), double(n.z)});
    for (int c = 0; c < 3; ++c) {
      const double side = length(as_double(p[(c + 1) % 3]) - as_double(p[c])) * step;
      Extent &here = extents[index_of(t[c])], &next = extents[index_of(t[(c + 1) % 3])];
      here.radius = std::max(here.radius, side);
      next.radius = std::max(next.radius, side);
      here.cone.add(cone);
    }
  }
  return extents;
}

void add_normals(const MeshHierarchy& hierarchy, std::size_t layer, NodeId node,
                 GrowingCone& cone) {
  for (std::uint32_t a = 0; a < hierarchy.layers[layer].attribute_count(node); ++a) {
    const StoredValue n = hierarchy.value(layer, node, static_cast<RelativeAttribute>(a));
    cone.add(GrowingCone::of({double(n[0]), double(n[1]), double(n[2])}));
  }
}

}  // namespace

void bound_splits(const Mesh& snapped, const std::vector<Vec3i>& leaf_positions,
                  const VertexForest& forest, MeshHierarchy& hierarchy) {
  VertexHierarchy& h = hierarchy.vertices;
  std::size_t normals = hierarchy.layers.size();
  for (std::size_t l = 0; l < hierarchy.layers.size(); ++l) {
    if (hierarchy.layers[l].role == AttributeRole::Normal) normals = l;
  }
  const bool has_normals = normals < hierarchy.layers.size();
  std::vector<Extent> extents = extents_of_leaves(snapped, leaf_positions, h.grid.step);
  if (has_normals) {
    for (std::uint32_t v = 0; v < forest.leaf_count; ++v) {
      add_normals(hierarchy, normals, forest.node_of_birth[v], extents[v].cone);
    }
  }
  extents.resize(forest.node_of_birth.size());
  for (std::uint32_t i : forest.from_left_to_right) {
    const SplitId s = forest.split_of_contraction[i];
    Extent all;
    for (bool second : {false, true}) {
      const Extent& child = extents[forest.children[i][second ? 1 : 0]];
      const double away = length(as_double(h.delta_of(h.child(s, second)))) * h.grid.step;
      all.radius = std::max(all.radius, away + child.radius);
      all.cone.add(child.cone);
    }
    if (has_normals) add_normals(hierarchy, normals, h.node_of_split[index_of(s)], all.cone);
    SplitBounds& bounds = h.bounds[index_of(s)];
    bounds.radius = rounded_up(all.radius);
    bounds.set_cone({{float(all.cone.axis.x), float(all.cone.axis.y), float(all.cone.axis.z)},
                     static_cast<float>(all.cone.half_angle)});
    // Upwards goes what was stored, so that spheres hold spheres.
    all.radius = double(bounds.radius.value());
    extents[forest.leaf_count + i] = all;
  }
}

}  // namespace crease
