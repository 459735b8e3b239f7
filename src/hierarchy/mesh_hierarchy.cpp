// The walks up and down, and where the bytes are.
#include "crease/mesh_hierarchy.h"

#include "hierarchy/grid_sum.h"

#include <algorithm>

namespace crease {

Vec3i VertexHierarchy::position_of(NodeId n) const {
  Vec3i delta{};
  for (; !is_root(n); n = parent(n)) delta = grid_sum(delta, delta_of(n));
  return grid_sum(root_positions[index_of(n)], delta);
}

RelativeAttribute MeshHierarchy::above(std::size_t layer, SplitId s, bool second,
                                       RelativeAttribute a, WedgeId) const {
  const AttributeHierarchy& attributes = layers[layer];
  const ParentMaps::Map parents = attributes.parents_of_split.of(index_of(s));
  if (parents.empty()) return 0;
  return parents[second ? attributes.attribute_count(vertices.first_child(s)) + a : a];
}

RelativeAttribute MeshHierarchy::below(std::size_t layer, SplitId s, bool second,
                                       RelativeAttribute a, WedgeId wedge) const {
  const AttributeHierarchy& attributes = layers[layer];
  const ParentMaps::Map all = attributes.parents_of_split.of(index_of(s));
  if (all.empty()) return 0;
  const std::uint32_t of_first = attributes.attribute_count(vertices.first_child(s));
  const ParentMaps::Map parents =
      second ? all.subspan(of_first, all.size() - of_first) : all.subspan(0, of_first);
  const auto next = [&](std::size_t from) {
    while (from < parents.size() && parents[from] != a) ++from;
    return from;
  };
  const std::size_t found = next(0);
  if (found == parents.size()) return 0;  // no corner with it stands there
  if (next(found + 1) == parents.size()) return static_cast<RelativeAttribute>(found);
  const std::span<const BranchRun> runs = attributes.branches_of_split.of(index_of(s));
  const auto after =
      std::upper_bound(runs.begin(), runs.end(), wedge,
                       [](WedgeId w, const BranchRun& run) { return w < run.first_wedge; });
  return after == runs.begin() ? RelativeAttribute{0} : (after - 1)->at_child;
}

RelativeAttribute MeshHierarchy::at_leaf(std::size_t layer, NodeId leaf, WedgeId wedge) const {
  const AttributeHierarchy& attributes = layers[layer];
  if (!attributes.leaf_attribute.empty()) return attributes.leaf_attribute[index_of(wedge)];
  const std::uint32_t count = attributes.attribute_count(leaf);
  if (count <= 1) return 0;
  std::size_t first = 0;
  if (vertices.is_root(leaf)) {
    first = index_of(vertices.root_wedges[index_of(leaf)]);
  } else {  // of two children, one begins where the other one ends
    first = index_of(vertices.second_wedge[index_of(vertices.split_above(leaf))]);
    if (!vertices.is_second(leaf)) first -= count;
  }
  return static_cast<RelativeAttribute>(index_of(wedge) - first);
}

// As attribute_at(), however deep it is.
RelativeAttribute MeshHierarchy::attribute_far_below(std::size_t layer, NodeId n,
                                                     WedgeId wedge) const {
  const AttributeHierarchy& attributes = layers[layer];
  NodeId at = n;
  SplitId s = kNoSplit;
  while (attributes.attribute_count(at) > 1 && (s = vertices.split_of(at)) != kNoSplit) {
    at = vertices.child(s, vertices.goes_to_second(s, wedge));
  }
  RelativeAttribute a =
      attributes.attribute_count(at) > 1 ? at_leaf(layer, at, wedge) : RelativeAttribute{0};
  for (; at != n; at = vertices.parent(at)) {
    a = above(layer, vertices.split_above(at), vertices.is_second(at), a, wedge);
  }
  return a;
}

// Down to where there is no choice, and up again by parent maps. What both ways need is noted on
// the way down; deeper than kMost is rare.
RelativeAttribute MeshHierarchy::attribute_at(std::size_t layer, NodeId n, WedgeId wedge) const {
  constexpr std::size_t kMost = 64;
  struct Step {
    SplitId split;
    std::uint32_t first;  // of the child's attributes in the map
  };
  Step steps[kMost];
  std::size_t count = 0;
  const AttributeHierarchy& attributes = layers[layer];
  std::uint32_t choices = attributes.attribute_count(n);
  SplitId s = kNoSplit;
  while (choices > 1 && (s = vertices.split_of(n)) != kNoSplit) {
    const bool second = vertices.goes_to_second(s, wedge);
    if (count == kMost) break;
    const auto ranges = attributes.attribute_ranges.two_ranges(index_of(vertices.first_child(s)));
    const std::uint32_t first = ranges[0].end - ranges[0].begin;
    steps[count++] = {s, second ? first : 0};
    choices = second ? ranges[1].end - ranges[1].begin : first;
    n = vertices.child(s, second);
  }
  RelativeAttribute a = 0;
  if (count == kMost && choices > 1 && s != kNoSplit) {
    a = attribute_far_below(layer, n, wedge);
  } else if (choices > 1) {
    a = at_leaf(layer, n, wedge);
  }
  while (count > 0) {
    const Step& step = steps[--count];
    const ParentMaps::Map parents = attributes.parents_of_split.of(index_of(step.split));
    a = parents.empty() ? RelativeAttribute{0} : parents[step.first + a];
  }
  return a;
}

std::uint32_t MeshHierarchy::value_index(std::size_t layer, NodeId n, RelativeAttribute a) const {
  const AttributeHierarchy& attributes = layers[layer];
  std::uint32_t i = attributes.attribute_ranges.begin(index_of(n)) + a;
  while (!attributes.has_own_value(i)) {
    const SplitId s = vertices.split_above(n);
    a = above(layer, s, vertices.is_second(n), a, WedgeId{});
    n = vertices.node_of_split[index_of(s)];
    i = attributes.attribute_ranges.begin(index_of(n)) + a;
  }
  return attributes.own_value(i);
}

namespace {

template <typename T>
std::size_t stored_bytes(const std::vector<T>& items) {
  return sizeof(T) * items.size();
}
template <typename Index>
std::size_t stored_bytes(const PackedIndices<Index>& items) {
  return items.bytes();
}

}  // namespace

HierarchyBytes hierarchy_bytes(const MeshHierarchy& hierarchy) {
  const VertexHierarchy& v = hierarchy.vertices;
  HierarchyBytes bytes;
  bytes.triangles = stored_bytes(v.triangles.of_corner) + v.triangle_ranges.bytes() +
                    stored_bytes(v.material_of_triangle) + stored_bytes(v.part_of_triangle) +
                    v.derived_of_split.bytes() + v.is_derived.bytes() +
                    stored_bytes(v.deriving_splits);
  bytes.positions = stored_bytes(v.root_positions) + stored_bytes(v.deltas) + v.is_wide.bytes() +
                    stored_bytes(v.wide_deltas);
  bytes.splits = v.is_split.bytes() + stored_bytes(v.node_of_split) + stored_bytes(v.second_wedge) +
                 stored_bytes(v.bounds) + stored_bytes(v.root_wedges);
  for (const AttributeHierarchy& layer : hierarchy.layers) {
    bytes.values +=
        layer.values.bytes() + stored_bytes(layer.value_of_attribute) + layer.has_value.bytes();
    bytes.attributes += layer.attribute_ranges.bytes() + stored_bytes(layer.leaf_attribute) +
                        layer.parents_of_split.bytes() + layer.branches_of_split.bytes() +
                        stored_bytes(layer.constant_of_wedge) + layer.keeps_values.bytes();
  }
  return bytes;
}

}  // namespace crease
