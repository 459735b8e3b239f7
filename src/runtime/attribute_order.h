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

#include <cstddef>
#include <cstdint>

namespace crease {

class AttributeOrder {
 public:
  AttributeOrder() = default;
  // Keeps no reference. Time O(nodes + attributes + wedges).
  AttributeOrder(const MeshHierarchy& hierarchy, std::size_t layer);

  bool empty() const { return place_of_wedge_.empty(); }
  // Of a corner that can stand at a node with several. Time O(attributes of the node).
  struct Node {
    std::size_t first;
    std::uint32_t count;
  };
  static Node node(const AttributeHierarchy& layer, NodeId n) {
    return {layer.attribute_ranges.unusual_before(index_of(n)), layer.attribute_count(n)};
  }
  RelativeAttribute attribute_at(const Node& node, WedgeId wedge) const {
    const std::uint32_t place = place_of_wedge_[index_of(wedge)];
    std::uint32_t found = 0, begin = 0;
    for (std::uint32_t a = 0; a < node.count; ++a) {
      const std::uint32_t next = begin_of_attribute_[node.first + a];
      const bool is_later = next <= place && next >= begin;
      found = is_later ? a : found;
      begin = is_later ? next : begin;
    }
    return static_cast<RelativeAttribute>(found);
  }
  std::size_t bytes() const { return place_of_wedge_.bytes() + begin_of_attribute_.bytes(); }

 private:
  PackedIndices<> place_of_wedge_;
  PackedIndices<> begin_of_attribute_;  // of nodes that have not one
};

}  // namespace crease
