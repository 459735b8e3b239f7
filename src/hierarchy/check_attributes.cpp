#include "hierarchy/check_attributes.h"

#include "hierarchy/hierarchy_walk.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

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
  if (layer.values.dimension() != layer.dimension || !layer.values.is_finite()) {
    return broken_layer(layer, "its values are not of its dimension or not finite");
  }
  const std::size_t values = layer.values.size();
  const bool indexed = !layer.value_of_attribute.empty();
  const bool inherits = layer.has_value.size() != 0;
  const std::size_t own = inherits ? layer.has_value.set_count() : attributes;
  if ((inherits && layer.has_value.size() != attributes) ||
      (indexed ? layer.value_of_attribute.size() != own : values != own)) {
    return broken_layer(layer, "an attribute lacks its value");
  }
  for (std::size_t i = 0; i < layer.value_of_attribute.size(); ++i) {
    if (layer.value_of_attribute[i] >= values) return broken_layer(layer, "value out of range");
  }
  if (!layer.leaf_attribute.empty() && layer.leaf_attribute.size() != vertices.wedge_count()) {
    return broken_layer(layer, "a wedge lacks its attribute");
  }
  const bool tells = !layer.keeps_values.empty() || !layer.constant_of_wedge.empty();
  if (tells && (layer.keeps_values.size() != splits ||
                layer.constant_of_wedge.size() != vertices.wedge_count())) {
    return broken_layer(layer, "where values stay is not told of all");
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

// The value of every attribute, from the roots down; and what is said of values that stay.
class ValueCheck {
 public:
  ValueCheck(const VertexHierarchy& vertices, const AttributeHierarchy& layer)
      : h_(vertices), layer_(layer), value_of_attribute_(layer.attribute_ranges.total()) {}

  Broken run() {
    for (std::uint32_t n = 0; n < h_.node_count(); ++n) {
      if (h_.is_root(NodeId{n})) {
        for (std::uint32_t i = begin(NodeId{n}); i < end(NodeId{n}); ++i) {
          if (!layer_.has_own_value(i)) return broken_value(NodeId{n});
          value_of_attribute_[i] = layer_.own_value(i);
        }
      }
    }
    for (std::uint32_t s = 0; s < h_.split_count(); ++s) {
      if (auto broken = take_values(SplitId{s})) return broken;
    }
    return std::nullopt;
  }
  std::vector<std::uint32_t> take() { return std::move(value_of_attribute_); }

 private:
  std::uint32_t begin(NodeId n) const { return layer_.attribute_ranges.begin(index_of(n)); }
  std::uint32_t end(NodeId n) const { return layer_.attribute_ranges.end(index_of(n)); }
  Failure broken_value(NodeId n) const {
    return broken_layer(layer_,
                        "nowhere to have a value from at node " + std::to_string(index_of(n)));
  }

  Broken take_values(SplitId s) {
    const ParentMaps::Map parents = layer_.parents_of_split.of(index_of(s));
    const std::uint32_t above = begin(h_.node_of_split[index_of(s)]);
    std::size_t member = 0;
    const bool is_said_to_keep =
        !layer_.keeps_values.empty() && layer_.keeps_values.test(index_of(s));
    const NodeId node = h_.node_of_split[index_of(s)];
    for (std::uint32_t i = above; !is_said_to_keep && i < end(node); ++i) {
      if (!layer_.has_own_value(i)) return broken_value(node);
    }
    bool keeps = true;
    for (NodeId child : {h_.first_child(s), h_.second_child(s)}) {
      const bool is_only = end(child) - begin(child) == 1;
      for (std::uint32_t i = begin(child); i < end(child); ++i, ++member) {
        const RelativeAttribute parent = parents.empty() ? kRemoved : parents[member];
        const bool has_own = layer_.has_own_value(i);
        if (!has_own && (is_only || parent == kRemoved || !is_said_to_keep)) {
          return broken_value(child);
        }
        value_of_attribute_[i] =
            has_own ? layer_.own_value(i) : value_of_attribute_[above + parent];
        keeps &=
            parent == kRemoved || value_of_attribute_[i] == value_of_attribute_[above + parent];
      }
    }
    if (!keeps && is_said_to_keep) {
      return broken_layer(layer_, "a value that should stay changes" + at_split(index_of(s)));
    }
    return std::nullopt;
  }

  const VertexHierarchy& h_;
  const AttributeHierarchy& layer_;
  std::vector<std::uint32_t> value_of_attribute_;
};

class CornerWalk {
 public:
  CornerWalk(const MeshHierarchy& hierarchy, std::size_t layer,
             const std::vector<NodeId>& leaf_of_wedge,
             const std::vector<std::uint32_t>& value_of_attribute)
      : hierarchy_(hierarchy),
        h_(hierarchy.vertices),
        number_(layer),
        layer_(hierarchy.layers[layer]),
        leaf_of_wedge_(leaf_of_wedge),
        value_of_attribute_(value_of_attribute),
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
    RelativeAttribute a = hierarchy_.at_leaf(number_, node, wedge);
    while (true) {
      if (a >= layer_.attribute_count(node)) {
        return broken_layer(layer_,
                            "an attribute is missing at node " + std::to_string(index_of(node)));
      }
      const std::size_t i = layer_.attribute_ranges.begin(index_of(node)) + a;
      is_used_[i] = true;
      const std::uint32_t constant =
          layer_.constant_of_wedge.empty() ? 0 : layer_.constant_of_wedge[index_of(wedge)];
      if (constant != 0 && constant - 1 != value_of_attribute_[i]) {
        return broken_layer(layer_,
                            "a constant value changes at node " + std::to_string(index_of(node)));
      }
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
  const std::vector<std::uint32_t>& value_of_attribute_;
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
  ValueCheck values(hierarchy.vertices, hierarchy.layers[layer]);
  if (auto broken = values.run()) return broken;
  return CornerWalk(hierarchy, layer, leaf_of_wedge, values.take()).run();
}

}  // namespace crease
