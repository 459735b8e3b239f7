#include "hierarchy/check_attributes.h"

#include "hierarchy/hierarchy_walk.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace crease {

namespace {

using Broken = std::optional<Failure>;

Failure broken_layer(const AttributeHierarchy& layer, const std::string& what) {
  return fail(Error::Invalid, "layer '" + layer.name + "': " + what);
}

std::string at_split(std::size_t s) {
  return " at split " + std::to_string(s);
}

Broken check_layer_sizes(const VertexHierarchy& vertices, const AttributeHierarchy& layer) {
  const std::size_t attributes = layer.attribute_ranges.total();
  const std::size_t splits = vertices.split_count();
  if (layer.dimension < 1 || layer.dimension > 4) return broken_layer(layer, "its dimension");
  if (layer.attribute_ranges.size() != vertices.node_count()) {
    return broken_layer(layer, "a node lacks its range of attributes");
  }
  if (layer.parents_of_split.size() != splits || layer.branches_of_split.size() != splits) {
    return broken_layer(layer, "a split lacks its parent map");
  }
  if (layer.values.size() % layer.dimension != 0 ||
      !std::all_of(layer.values.begin(), layer.values.end(),
                   [](float f) { return std::isfinite(f); })) {
    return broken_layer(layer, "its values are odd in number or not finite");
  }
  const std::size_t values = layer.values.size() / layer.dimension;
  const bool indexed = !layer.value_of_attribute.empty();
  if (indexed ? layer.value_of_attribute.size() != attributes : values != attributes) {
    return broken_layer(layer, "an attribute lacks its value");
  }
  for (std::size_t i = 0; i < layer.value_of_attribute.size(); ++i) {
    if (layer.value_of_attribute[i] >= values) return broken_layer(layer, "value out of range");
  }
  if (!layer.leaf_attribute.empty() && layer.leaf_attribute.size() != vertices.wedge_count()) {
    return broken_layer(layer, "a wedge lacks its attribute");
  }
  return std::nullopt;
}

Broken check_maps(const VertexHierarchy& vertices, const AttributeHierarchy& layer) {
  for (std::uint32_t s = 0; s < vertices.split_count(); ++s) {
    const std::uint32_t at_s = layer.attribute_count(vertices.node_of_split[s]);
    const std::uint32_t at_t = layer.attribute_count(vertices.first_child(SplitId{s}));
    const std::uint32_t at_u = layer.attribute_count(vertices.second_child(SplitId{s}));
    const ParentMaps::Map parents = layer.parents_of_split.of(s);
    if (parents.empty()) {
      if (at_s > 1 || (at_s == 1 && (at_t > 1 || at_u > 1))) {
        return broken_layer(layer, "no parent map" + at_split(s));
      }
      continue;
    }
    bool fits = parents.size() == at_t + at_u;
    for (std::size_t i = 0; fits && i < parents.size(); ++i) {
      fits = parents[i] == kRemoved || parents[i] < at_s;
    }
    if (!fits) return broken_layer(layer, "a wrong parent map" + at_split(s));
    const std::span<const BranchRun> runs = layer.branches_of_split.of(s);
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const bool second = vertices.goes_to_second(SplitId{s}, runs[r].first_wedge);
      if (runs[r].at_child >= (second ? at_u : at_t) ||
          (r > 0 && runs[r].first_wedge <= runs[r - 1].first_wedge)) {
        return broken_layer(layer, "a wrong branch code" + at_split(s));
      }
    }
  }
  return std::nullopt;
}

class CornerWalk {
 public:
  CornerWalk(const MeshHierarchy& hierarchy, std::size_t layer,
             const std::vector<NodeId>& leaf_of_wedge)
      : hierarchy_(hierarchy),
        h_(hierarchy.vertices),
        number_(layer),
        layer_(hierarchy.layers[layer]),
        leaf_of_wedge_(leaf_of_wedge),
        is_used_(layer_.attribute_ranges.total(), false) {}

  Broken run() {
    for (std::size_t n = 0; n < h_.triangles.size(); ++n) {
      const std::array<WedgeId, 3> t = h_.triangles[n];
      NodeId leaf[3], both[3];
      for (std::size_t c = 0; c < 3; ++c) leaf[c] = leaf_of_wedge_[index_of(t[c])];
      for (std::size_t c = 0; c < 3; ++c) {
        both[c] = lowest_common_ancestor(h_, leaf[c], leaf[(c + 1) % 3]);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        // Up to where it meets another corner of its triangle; of two, the lower node.
        NodeId end = both[c];
        const NodeId other = both[(c + 2) % 3];
        if (end == kNoNode || (other != kNoNode && other > end)) end = other;
        if (auto broken = walk(t[c], leaf[c], end)) return broken;
      }
    }
    if (std::find(is_used_.begin(), is_used_.end(), false) != is_used_.end()) {
      return broken_layer(layer_, "an attribute that no cut can show");
    }
    return std::nullopt;
  }

 private:
  Broken walk(WedgeId wedge, NodeId node, NodeId end) {
    RelativeAttribute a = layer_.leaf_attribute.empty() ? RelativeAttribute{0}
                                                        : layer_.leaf_attribute[index_of(wedge)];
    while (true) {
      if (a >= layer_.attribute_count(node)) {
        return broken_layer(layer_,
                            "an attribute is missing at node " + std::to_string(index_of(node)));
      }
      is_used_[layer_.attribute_ranges.begin(index_of(node)) + a] = true;
      if (h_.is_root(node) || h_.parent(node) == end) return std::nullopt;
      const SplitId s = h_.split_above(node);
      const bool second = h_.is_second(node);
      const RelativeAttribute above = hierarchy_.above(number_, s, second, a, wedge);
      if (above == kRemoved) {
        return broken_layer(layer_, "a live attribute is removed" + at_split(index_of(s)));
      }
      if (hierarchy_.below(number_, s, second, above, wedge) != a) {
        return broken_layer(layer_, "the way down is not the way up" + at_split(index_of(s)));
      }
      a = above;
      node = h_.parent(node);
    }
  }

  const MeshHierarchy& hierarchy_;
  const VertexHierarchy& h_;
  const std::size_t number_;
  const AttributeHierarchy& layer_;
  const std::vector<NodeId>& leaf_of_wedge_;
  std::vector<bool> is_used_;
};

}  // namespace

Broken check_attribute_sizes(const MeshHierarchy& hierarchy) {
  for (const AttributeHierarchy& layer : hierarchy.layers) {
    if (auto broken = check_layer_sizes(hierarchy.vertices, layer)) return broken;
  }
  return std::nullopt;
}

Broken check_attributes(const MeshHierarchy& hierarchy, std::size_t layer,
                        const std::vector<NodeId>& leaf_of_wedge) {
  if (auto broken = check_maps(hierarchy.vertices, hierarchy.layers[layer])) return broken;
  return CornerWalk(hierarchy, layer, leaf_of_wedge).run();
}

}  // namespace crease
