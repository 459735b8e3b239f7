// Full resolution beside the mesh that the hierarchy was made of.
#include "crease/build_hierarchy.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

namespace crease {

namespace {

using Broken = std::optional<Failure>;

Failure not_the_mesh(std::size_t triangle, const std::string& what) {
  return fail(Error::Invalid, "full resolution: another " + what + " at triangle " +
                                  std::to_string(triangle) + " of the mesh");
}

class LeafChecker {
 public:
  LeafChecker(const MeshHierarchy& hierarchy, const HierarchyMaps& maps, const Mesh& snapped)
      : hierarchy_(hierarchy), h_(hierarchy.vertices), maps_(maps), mesh_(snapped) {}

  Broken run() {
    if (h_.triangles.size() != mesh_.triangle_count() ||
        maps_.new_of_triangle.size() != mesh_.triangle_count() ||
        maps_.leaf_of_vertex.size() != mesh_.vertex_count() ||
        hierarchy_.layers.size() != mesh_.layers.size() ||
        hierarchy_.materials != mesh_.materials || hierarchy_.parts != mesh_.parts) {
      return fail(Error::Invalid,
                  "full resolution: another number of triangles, vertices or layers");
    }
    if (auto broken = check_corners()) return broken;
    for (std::size_t l = 0; l < mesh_.layers.size(); ++l) {
      if (auto broken = check_layer(l)) return broken;
    }
    return std::nullopt;
  }

 private:
  std::size_t place(std::size_t triangle) const {
    return index_of(maps_.new_of_triangle[triangle]);
  }
  NodeId leaf(std::size_t triangle, std::size_t corner) const {
    return maps_.leaf_of_vertex[index_of(mesh_.triangles[triangle][corner])];
  }

  // Where the wedge of a corner is when all is split.
  NodeId leaf_of(WedgeId wedge) const {
    NodeId n = h_.root_of(wedge);
    for (SplitId s = h_.split_of(n); s != kNoSplit; s = h_.split_of(n)) {
      n = h_.child(s, h_.goes_to_second(s, wedge));
    }
    return n;
  }

  Broken check_corners() const {
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
      const NodeId n = maps_.leaf_of_vertex[v];
      if (h_.position_of(n) == h_.grid.nearest(mesh_.positions[v])) continue;
      return fail(Error::Invalid,
                  "full resolution: another position of vertex " + std::to_string(v));
    }
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const std::array<WedgeId, 3> wedges = h_.triangles[place(t)];
      for (std::size_t c = 0; c < 3; ++c) {
        if (leaf_of(wedges[c]) != leaf(t, c)) return not_the_mesh(t, "vertex");
      }
      if (!mesh_.material_of_triangle.empty() &&
          h_.material_of_triangle[place(t)] != mesh_.material_of_triangle[t]) {
        return not_the_mesh(t, "material");
      }
      if (!mesh_.part_of_triangle.empty() &&
          h_.part_of_triangle[place(t)] != mesh_.part_of_triangle[t]) {
        return not_the_mesh(t, "part");
      }
    }
    return std::nullopt;
  }

  // Each attribute of a leaf stands for one of the mesh, and no two of a leaf for the same.
  Broken check_layer(std::size_t l) const {
    const AttributeLayer& source = mesh_.layers[l];
    const AttributeHierarchy& layer = hierarchy_.layers[l];
    std::vector<AttributeId> id_of(layer.attribute_ranges.total(), kNoAttribute);
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const NodeId n = leaf(t, c);
        const RelativeAttribute a = hierarchy_.attribute_at(l, n, h_.triangles[place(t)][c]);
        const AttributeId id = source.of_corner[3 * t + c];
        const StoredValue shown = hierarchy_.value(l, n, a);
        const std::span<const float> asked = source.value(id);
        if (shown.size() != asked.size() ||
            std::memcmp(shown.begin(), asked.data(), asked.size_bytes()) != 0) {
          return not_the_mesh(t, "value of layer '" + source.name + "'");
        }
        AttributeId& noted = id_of[layer.attribute_ranges.begin(index_of(n)) + a];
        if (noted != kNoAttribute && noted != id) return not_the_mesh(t, "sharing of attributes");
        noted = id;
      }
    }
    for (const NodeId n : maps_.leaf_of_vertex) {
      const auto first = id_of.begin() + layer.attribute_ranges.begin(index_of(n));
      const auto last = first + layer.attribute_count(n);
      std::sort(first, last);
      if (std::adjacent_find(first, last) == last) continue;
      return fail(Error::Invalid, "full resolution: corners of layer '" + source.name +
                                      "' no longer share an attribute");
    }
    return std::nullopt;
  }

  const MeshHierarchy& hierarchy_;
  const VertexHierarchy& h_;
  const HierarchyMaps& maps_;
  const Mesh& mesh_;
};

}  // namespace

Status check_leaves(const MeshHierarchy& hierarchy, const HierarchyMaps& maps,
                    const Mesh& snapped) {
  if (auto broken = LeafChecker(hierarchy, maps, snapped).run()) return *broken;
  return Done{};
}

}  // namespace crease
