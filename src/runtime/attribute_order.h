// Which attribute a wedge has at a node, without walking there: the wedges in the order of the
// attribute forest of a layer.
//
//   AttributeOrder order(hierarchy, layer);
//   RelativeAttribute a = order.attribute_at(order.node(layer, n), wedge);  // as
//   MeshHierarchy::attribute_at()
//
// An attribute has one parent, so attributes and below them wedges are trees. Where wedges are
// numbered tree by tree, from left to right, every attribute has a range of them, and those of one
// node have ranges apart: a wedge has the one that begins last at or before it. (The numbers that
// wedges have follow the leaves, so that a node has a range; an attribute has none there.)
//
// Walking down to where there is no choice and up again took a thousand instructions on CAD models,
// 0.8 times a move.
//
// Memory: a number a wedge, and one per attribute of a node that has several.
#pragma once

#include "crease/mesh_hierarchy.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace crease {

class AttributeOrder {
 public:
  AttributeOrder() = default;
  // Keeps no reference. Time O(nodes + attributes + wedges).
  AttributeOrder(const MeshHierarchy& hierarchy, std::size_t layer);

  bool empty() const { return place_of_wedge_.empty(); }
  // Of the attributes of a node with several, the first few as numbers.
  struct Node {
    static constexpr std::uint32_t kFew = 4;
    std::size_t first;
    std::uint32_t begin;  // of its attributes, in the layer
    std::uint32_t count;
    std::array<std::uint32_t, kFew> begins;
  };
  Node node(const AttributeHierarchy& layer, NodeId n) const {
    const auto at = layer.attribute_ranges.range_among_unusual(index_of(n));
    Node node{at.unusual_before, at.range.begin, at.range.end - at.range.begin, {}};
    const std::uint32_t last = node.count - (node.count > 0 ? 1 : 0);
    for (std::uint32_t a = 0; a < Node::kFew; ++a) {
      const std::uint32_t beyond = 0 - std::uint32_t(a >= node.count);  // all bits
      node.begins[a] = begin_of_attribute_[node.first + std::min(a, last)] | beyond;
    }
    return node;
  }
  // Of a corner that can stand there. Time O(attributes of the node).
  RelativeAttribute attribute_at(const Node& node, WedgeId wedge) const {
    const std::uint32_t place = place_of_wedge_[index_of(wedge)];
    std::uint64_t last = 0;  // its begin, and then which it is
    const auto look_at = [&](std::uint32_t a, std::uint32_t begin) {
      const std::uint64_t counts = 0 - std::uint64_t(begin <= place);  // all bits, or none
      last = std::max(last, (std::uint64_t(begin) << 32 | a) & counts);
    };
    for (std::uint32_t a = 0; a < Node::kFew; ++a) look_at(a, node.begins[a]);
    for (std::uint32_t a = Node::kFew; a < node.count; ++a) {
      look_at(a, begin_of_attribute_[node.first + a]);
    }
    return static_cast<RelativeAttribute>(last);
  }
  std::size_t bytes() const { return place_of_wedge_.bytes() + begin_of_attribute_.bytes(); }

 private:
  PackedIndices<> place_of_wedge_;
  PackedIndices<> begin_of_attribute_;  // of nodes that have not one
};

}  // namespace crease
