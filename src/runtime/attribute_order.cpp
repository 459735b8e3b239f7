#include "runtime/attribute_order.h"

#include "hierarchy/hierarchy_walk.h"

#include <utility>
#include <vector>

namespace crease {

namespace {

// Attributes by their places in attribute_ranges. Splits are numbered from the roots down.
class Forest {
 public:
  Forest(const MeshHierarchy& hierarchy, std::size_t layer)
      : hierarchy_(hierarchy),
        number_(layer),
        layer_(hierarchy.layers[layer]),
        leaf_of_wedge_(leaves_of_wedges(hierarchy.vertices, wedge_ranges(hierarchy.vertices))) {}

  // The first wedge of each attribute, in the forest's order.
  std::vector<std::uint32_t> begins() const {
    const std::vector<std::uint32_t> sizes = wedge_counts();
    std::vector<std::uint32_t> begins(sizes.size(), 0), next(sizes.size(), 0);
    std::uint32_t end = 0;
    const auto place = [&](std::uint32_t attribute, std::uint32_t& from) {
      begins[attribute] = next[attribute] = from;
      from += sizes[attribute];
    };
    const VertexHierarchy& h = hierarchy_.vertices;
    for (std::uint32_t r = 0; r < h.root_count; ++r) {
      const CompactRanges::Range range = layer_.attribute_ranges.range(r);
      for (std::uint32_t i = range.begin; i < range.end; ++i) place(i, end);
    }
    for (std::uint32_t s = 0; s < h.split_count(); ++s) {
      visit_children(SplitId{s}, [&](std::uint32_t child, std::uint32_t parent) {
        place(child, parent == kNone ? end : next[parent]);
      });
    }
    return begins;
  }

  // kNone where no cut can show the wedge.
  std::uint32_t attribute_of(WedgeId wedge) const {
    const NodeId leaf = leaf_of_wedge_[index_of(wedge)];
    const RelativeAttribute a = hierarchy_.at_leaf(number_, leaf, wedge);
    const CompactRanges::Range range = layer_.attribute_ranges.range(index_of(leaf));
    return range.begin + a < range.end ? range.begin + a : kNone;
  }

 private:
  // Calls visit(attribute, its parent or kNone) for each at a child of s.
  template <typename Visit>
  void visit_children(SplitId s, Visit visit) const {
    const VertexHierarchy& h = hierarchy_.vertices;
    const auto above = layer_.attribute_ranges.range(index_of(h.node_of_split[index_of(s)]));
    const auto below = layer_.attribute_ranges.two_ranges(index_of(h.first_child(s)));
    const ParentMaps::Map parents = layer_.parents_of_split.of(index_of(s));
    for (std::uint32_t i = below[0].begin; i < below[1].end; ++i) {
      const std::uint32_t a = parents.empty() ? 0 : parents[i - below[0].begin];
      visit(i, above.begin + a < above.end ? above.begin + a : kNone);
    }
  }

  std::vector<std::uint32_t> wedge_counts() const {
    std::vector<std::uint32_t> counts(layer_.attribute_ranges.total(), 0);
    for (std::uint32_t w = 0; w < leaf_of_wedge_.size(); ++w) {
      if (const std::uint32_t i = attribute_of(WedgeId{w}); i != kNone) ++counts[i];
    }
    for (auto s = static_cast<std::uint32_t>(hierarchy_.vertices.split_count()); s-- > 0;) {
      visit_children(SplitId{s}, [&](std::uint32_t child, std::uint32_t parent) {
        if (parent != kNone) counts[parent] += counts[child];
      });
    }
    return counts;
  }

  const MeshHierarchy& hierarchy_;
  const std::size_t number_;
  const AttributeHierarchy& layer_;
  std::vector<NodeId> leaf_of_wedge_;
};

}  // namespace

AttributeOrder::AttributeOrder(const MeshHierarchy& hierarchy, std::size_t layer)
    : place_of_wedge_(bits_for(hierarchy.vertices.wedge_count())),
      begin_of_attribute_(bits_for(hierarchy.vertices.wedge_count())) {
  const Forest forest(hierarchy, layer);
  std::vector<std::uint32_t> begins = forest.begins();
  const CompactRanges& ranges = hierarchy.layers[layer].attribute_ranges;
  for (std::size_t n = 0; n < ranges.size(); ++n) {
    if (ranges.is_usual(n)) continue;
    const CompactRanges::Range range = ranges.range(n);
    for (std::uint32_t i = range.begin; i < range.end; ++i)
      begin_of_attribute_.push_back(begins[i]);
  }
  for (std::uint32_t a = 0; a < Node::kFew; ++a) begin_of_attribute_.push_back(0);
  for (std::uint32_t w = 0; w < hierarchy.vertices.wedge_count(); ++w) {
    const std::uint32_t attribute = forest.attribute_of(WedgeId{w});
    place_of_wedge_.push_back(attribute == kNone ? 0 : begins[attribute]++);
  }
}

}  // namespace crease
