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
#include <limits>

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
    std::array<std::uint64_t, kFew> begins;  // where an attribute begins, above which it is
  };
  Node node(const AttributeHierarchy& layer, NodeId n) const {
    const auto at = layer.attribute_ranges.range_among_unusual(index_of(n));
    Node node{at.unusual_before, at.range.begin, at.range.end - at.range.begin, {}};
    const auto three = begin_of_attribute_.three_from(node.first);
    node.begins = {key(three[0], 0), key(three[1], 1), key(three[2], 2),
                   key(begin_of_attribute_[node.first + 3], 3)};
    for (std::uint32_t a = 0; a < Node::kFew; ++a) {
      node.begins[a] |= 0 - std::uint64_t(a >= node.count);  // all bits: beyond any place
    }
    return node;
  }
  // Of a corner that can stand there. Time O(attributes of the node).
  RelativeAttribute attribute_at(const Node& node, WedgeId wedge) const {
    const std::uint64_t place = key(place_of_wedge_[index_of(wedge)], kMostAttribute);
    std::uint64_t back = ~std::uint64_t(0);  // to the last begin; what is beyond the place wraps
    for (const std::uint64_t begin : node.begins) back = std::min(back, place - begin);
    for (std::uint32_t a = Node::kFew; a < node.count; ++a) {
      back = std::min(back, place - key(begin_of_attribute_[node.first + a], a));
    }
    return static_cast<RelativeAttribute>(place - back);
  }
  std::size_t bytes() const { return place_of_wedge_.bytes() + begin_of_attribute_.bytes(); }

 private:
  static constexpr std::uint32_t kMostAttribute = std::numeric_limits<RelativeAttribute>::max();
  static std::uint64_t key(std::uint32_t begin, std::uint32_t a) {
    return std::uint64_t(begin) << std::numeric_limits<RelativeAttribute>::digits | a;
  }

  PackedIndices<> place_of_wedge_;
  PackedIndices<> begin_of_attribute_;  // of nodes that have not one, and kFew more
};

}  // namespace crease
