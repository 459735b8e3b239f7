// The vertex hierarchy's invariants: sizes, numbers, triangles, bounds. Those of the attributes are
// in check_attributes.cpp.
#include "crease/mesh_hierarchy.h"

#include "hierarchy/check_attributes.h"
#include "hierarchy/geometric_normal.h"
#include "hierarchy/grid_sum.h"
#include "hierarchy/hierarchy_walk.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace crease {

namespace {

using Broken = std::optional<Failure>;

Failure broken_hierarchy(const std::string& what) {
  return fail(Error::Invalid, "hierarchy: " + what);
}

Failure broken_split(std::size_t split, const std::string& what) {
  return fail(Error::Invalid, "split " + std::to_string(split) + ": " + what);
}

Failure broken_triangle(std::size_t triangle, const std::string& what) {
  return fail(Error::Invalid, "triangle " + std::to_string(triangle) + ": " + what);
}

Vec3d as_double(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

class VertexChecker {
 public:
  explicit VertexChecker(const MeshHierarchy& hierarchy)
      : hierarchy_(hierarchy), h_(hierarchy.vertices) {}

  Broken run() {
    if (auto broken = check_sizes()) return broken;
    if (auto broken = check_numbers()) return broken;
    find_places();
    if (auto broken = check_triangles()) return broken;
    if (auto broken = check_derived()) return broken;
    return check_spheres();
  }

  // The attributes must hold.
  Broken check_cones() {
    for (const SplitBounds& bounds : h_.bounds) {
      const NormalCone cone = bounds.cone();
      const bool all = bounds.cone_angle == 255;
      constexpr float kRounding = 2e-6f;
      cones_.push_back({cone.axis, all ? -2 : std::cos(cone.half_angle_rad) - kRounding});
    }
    if (auto broken = check_cones_of_triangles()) return broken;
    for (std::size_t l = 0; l < hierarchy_.layers.size(); ++l) {
      const AttributeHierarchy& layer = hierarchy_.layers[l];
      if (layer.role != AttributeRole::Normal) continue;
      for (std::uint32_t n = 0; n < h_.node_count(); ++n) {
        for (std::uint32_t a = 0; a < layer.attribute_count(NodeId{n}); ++a) {
          const auto value = hierarchy_.value(l, NodeId{n}, static_cast<RelativeAttribute>(a));
          if (auto broken = check_cones_above(NodeId{n}, {value[0], value[1], value[2]})) {
            return broken;
          }
        }
      }
    }
    return std::nullopt;
  }

  const std::vector<NodeId>& leaf_of_wedge() const { return leaf_of_wedge_; }

 private:
  Broken check_sizes() const {
    const std::size_t splits = h_.split_count(), nodes = h_.node_count();
    const std::size_t triangles = h_.triangles.size();
    if (nodes != h_.root_count + 2 * splits || h_.is_split.set_count() != splits) {
      return broken_hierarchy("nodes, roots and splits do not add up");
    }
    if (h_.root_positions.size() != h_.root_count || h_.root_wedges.size() != h_.root_count + 1u) {
      return broken_hierarchy("a root lacks its position or wedges");
    }
    if (h_.second_wedge.size() != splits || h_.bounds.size() != splits ||
        h_.derived_of_split.size() != splits || h_.triangle_ranges.size() != splits + 1) {
      return broken_hierarchy("an array of splits has another size");
    }
    if (h_.deltas.size() != 6 * splits || (splits > 0 && h_.deltas.bits() == 0) ||
        h_.triangles.of_corner.size() % 3 != 0 || h_.is_wide.size() != 2 * splits ||
        h_.is_wide.set_count() != h_.wide_deltas.size()) {
      return broken_hierarchy("a node lacks its position");
    }
    const auto one_each = [triangles](std::size_t size) { return size == 0 || size == triangles; };
    if (h_.triangle_ranges.total() != triangles || !one_each(h_.material_of_triangle.size()) ||
        !one_each(h_.part_of_triangle.size()) || !one_each(h_.is_derived.size()) ||
        h_.is_derived.set_count() != h_.deriving_splits.size()) {
      return broken_hierarchy("an array of triangles has another size");
    }
    return std::nullopt;
  }

  Broken check_numbers() const {
    for (std::uint32_t s = 0; s < h_.split_count(); ++s) {
      const NodeId n = h_.node_of_split[s];
      if (n >= h_.first_child(SplitId{s}))
        return broken_split(s, "its node is not above its children");
      if (h_.split_of(n) != SplitId{s}) return broken_split(s, "its node has another split");
    }
    if (!std::is_sorted(h_.root_wedges.begin(), h_.root_wedges.end()) ||
        (!h_.root_wedges.empty() && h_.root_wedges[0] != WedgeId{0})) {
      return broken_hierarchy("the roots' wedges do not ascend from 0");
    }
    const std::vector<WedgeRange> ranges = wedge_ranges(h_);
    for (std::uint32_t s = 0; s < h_.split_count(); ++s) {
      const WedgeRange all = ranges[index_of(h_.node_of_split[s])];
      const std::size_t middle = index_of(h_.second_wedge[s]);
      if (middle < all.begin || middle > all.end) {
        return broken_split(s, "the wedges of v_u are not among those of v_s");
      }
    }
    for (std::size_t t = 0; t < h_.material_of_triangle.size(); ++t) {
      if (index_of(h_.material_of_triangle[t]) >= hierarchy_.materials.size()) {
        return broken_hierarchy("material out of range");
      }
    }
    for (std::size_t t = 0; t < h_.part_of_triangle.size(); ++t) {
      if (index_of(h_.part_of_triangle[t]) >= hierarchy_.parts.size()) {
        return broken_hierarchy("part out of range");
      }
    }
    return std::nullopt;
  }

  void find_places() {
    leaf_of_wedge_ = leaves_of_wedges(h_, wedge_ranges(h_));
    positions_ = h_.root_positions;
    for (std::uint32_t n = h_.root_count; n < h_.node_count(); ++n) {
      positions_.push_back(
          grid_sum(positions_[index_of(h_.parent(NodeId{n}))], h_.delta_of(NodeId{n})));
    }
  }

  // Every triangle is introduced where it collapses.
  Broken check_triangles() const {
    for (std::size_t key = 0; key <= h_.split_count(); ++key) {
      for (std::uint32_t t = h_.triangle_ranges.begin(key); t < h_.triangle_ranges.end(key); ++t) {
        NodeId deepest = kNoNode;
        for (int c = 0; c < 3; ++c) {
          const std::size_t a = index_of(h_.triangles[t][std::size_t(c)]);
          const std::size_t b = index_of(h_.triangles[t][std::size_t((c + 1) % 3)]);
          if (a >= leaf_of_wedge_.size() || b >= leaf_of_wedge_.size()) {
            return broken_triangle(t, "wedge out of range");
          }
          if (leaf_of_wedge_[a] == leaf_of_wedge_[b]) {
            return broken_triangle(t, "two corners at one leaf");
          }
          const NodeId both = lowest_common_ancestor(h_, leaf_of_wedge_[a], leaf_of_wedge_[b]);
          if (both == kNoNode) continue;
          // Of two nodes on one way up, the one below has the greater number.
          if (deepest == kNoNode || both > deepest) deepest = both;
        }
        const bool right = key == 0 ? deepest == kNoNode : deepest == h_.node_of_split[key - 1];
        if (!right) return broken_triangle(t, "not introduced where it collapses");
      }
    }
    return std::nullopt;
  }

  Broken check_derived() const {
    std::size_t listed = 0;
    for (std::uint32_t s = 0; s < h_.split_count(); ++s) {
      for (TriangleId t : h_.derived_of_split.of(s)) {
        if (index_of(t) >= h_.triangles.size() || h_.deriving_split(t) != SplitId{s}) {
          return broken_split(s, "a derived triangle names another split");
        }
        ++listed;
      }
    }
    if (listed != h_.deriving_splits.size()) {
      return broken_hierarchy("a derived triangle is not in its split's list");
    }
    return std::nullopt;
  }

  static bool at_least(const LevelError& a, const LevelError& b) {
    return a.surface >= b.surface && a.line >= b.line && a.degrees >= b.degrees &&
           a.texture >= b.texture;
  }

  Broken check_spheres() const {
    std::vector<double> leaf_radius(h_.node_count(), 0);  // grid units
    for (std::size_t n = 0; n < h_.triangles.size(); ++n) {
      const std::array<WedgeId, 3> t = h_.triangles[n];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t a = index_of(leaf_of_wedge_[index_of(t[c])]);
        const std::size_t b = index_of(leaf_of_wedge_[index_of(t[(c + 1) % 3])]);
        const double side = length(as_double(positions_[a]) - as_double(positions_[b]));
        leaf_radius[a] = std::max(leaf_radius[a], side);
        leaf_radius[b] = std::max(leaf_radius[b], side);
      }
    }
    for (std::uint32_t s = 0; s < h_.split_count(); ++s) {
      const SplitBounds& bounds = h_.bounds[s];
      for (bool second : {false, true}) {
        const NodeId child = h_.child(SplitId{s}, second);
        double radius = leaf_radius[index_of(child)] * h_.grid.step;
        if (const SplitId below = h_.split_of(child); below != kNoSplit) {
          const SplitBounds& other = h_.bounds[index_of(below)];
          if (!at_least(bounds.error(), other.error())) {
            return broken_split(s, "its error is less than that of a split under it");
          }
          radius = double(other.radius.value());
        }
        const double away = length(as_double(h_.delta_of(child))) * h_.grid.step;
        if (!(away + radius <= double(bounds.radius.value()))) {
          return broken_split(s, "its sphere does not hold those below");
        }
      }
    }
    return std::nullopt;
  }

  // Whether the cones from `node` up hold a direction.
  Broken check_cones_above(NodeId node, const Vec3f& direction) const {
    const Vec3f n = normalized(direction);
    if (n == Vec3f{}) return std::nullopt;
    while (true) {
      if (const SplitId s = h_.split_of(node); s != kNoSplit) {
        const ConeTest& cone = cones_[index_of(s)];
        if (dot(cone.axis, n) < cone.least_cosine) {
          return broken_split(index_of(s), "its cone does not hold the normals below");
        }
      }
      if (h_.is_root(node)) return std::nullopt;
      node = h_.parent(node);
    }
  }

  Broken check_cones_of_triangles() const {
    for (std::size_t i = 0; i < h_.triangles.size(); ++i) {
      const std::array<WedgeId, 3> t = h_.triangles[i];
      NodeId leaf[3];
      for (std::size_t c = 0; c < 3; ++c) leaf[c] = leaf_of_wedge_[index_of(t[c])];
      const Vec3f n = geometric_normal(positions_[index_of(leaf[0])], positions_[index_of(leaf[1])],
                                       positions_[index_of(leaf[2])]);
      for (NodeId node : leaf) {
        if (auto broken = check_cones_above(node, n)) return broken;
      }
    }
    return std::nullopt;
  }

  struct ConeTest {
    Vec3f axis;
    float least_cosine;
  };

  const MeshHierarchy& hierarchy_;
  const VertexHierarchy& h_;
  std::vector<NodeId> leaf_of_wedge_;
  std::vector<Vec3i> positions_;
  std::vector<ConeTest> cones_;
};

}  // namespace

Status check_hierarchy(const MeshHierarchy& hierarchy) {
  if (auto broken = check_attribute_sizes(hierarchy)) return *broken;
  VertexChecker vertices(hierarchy);
  if (auto broken = vertices.run()) return *broken;
  for (std::size_t l = 0; l < hierarchy.layers.size(); ++l) {
    if (auto broken = check_attributes(hierarchy, l, vertices.leaf_of_wedge())) return *broken;
  }
  if (auto broken = vertices.check_cones()) return *broken;
  return Done{};
}

}  // namespace crease
