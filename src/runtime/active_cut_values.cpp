// The values of corners, whose vertices move.
#include "runtime/active_cut.h"

#include <algorithm>

namespace crease {

namespace {

bool keeps_values(const AttributeHierarchy& layer, SplitId s) {
  return !layer.keeps_values.empty() && layer.keeps_values.test(index_of(s));
}

}  // namespace

// What a corner that comes to v shows, if its wedge varies. Another corner of it often stands there
// already: of those in `seen`.
std::uint32_t ActiveCut::varying_value_at(std::size_t place, const ActiveVertex& v, WedgeId wedge,
                                          const CornerLists::View& seen) const {
  const std::uint32_t l = tracked_[place];
  if (!orders_[place].empty()) {
    const AttributeHierarchy& layer = hierarchy_.layers[l];
    const AttributeOrder::Node node = orders_[place].node(layer, v.node);
    return layer.stored_value(layer.place_of_value(node.begin) +
                              orders_[place].attribute_at(node, wedge));
  }
  for (const CornerAt at : seen) {
    if (at.wedge == wedge) return kept_value(at, place);
  }
  return hierarchy_.value_index(l, v.node, hierarchy_.attribute_at(l, v.node, wedge));
}

// On the way between a node and one below it.
bool ActiveCut::keeps_between(std::size_t place, NodeId above, NodeId below) const {
  const AttributeHierarchy& layer = hierarchy_.layers[tracked_[place]];
  while (below != above) {
    const SplitId s = h_.split_above(below);
    if (!keeps_values(layer, s)) return false;
    below = h_.node_of_split[index_of(s)];
  }
  return true;
}

// Of the corners in f's list, which come to v.
void ActiveCut::renew_values(const Following& f, const ActiveVertex& v, std::size_t place) {
  const CornerLists::View corners = corners_of(f.slot);
  if (corners.size() == 0) return;
  const AttributeHierarchy& layer = hierarchy_.layers[tracked_[place]];
  const bool goes_up = index_of(f.from) > index_of(v.node);
  const bool keeps = keeps_between(place, goes_up ? v.node : f.from, goes_up ? f.from : v.node);
  const CompactRanges::Range before = layer.attribute_ranges.range(index_of(f.from));
  if (keeps && before.end - before.begin > 1) return;
  const std::uint32_t only = keeps ? layer.own_value(before.begin) : kNone;
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    const CornerAt at = corners[i];
    const CornerLists::View seen =
        &v == &vertices_[f.slot] ? corners.first(i) : lists_.of(v.corners);
    const std::uint32_t value = keeps ? only : value_at(place, v, at.wedge, seen);
    ActiveTriangles& part = parts_[at.corner.part()];
    std::uint32_t& kept = part.values[tracked_.size() * at.corner.index() + place];
    part.touched.mark_if(at.corner.triangle(), value != kept);
    kept = value;
  }
}

// Looks up what all corners in a list have at v.
void ActiveCut::look_up_values(const CornerList& list, const ActiveVertex& v, std::size_t place) {
  const AttributeHierarchy& layer = hierarchy_.layers[tracked_[place]];
  const AttributeOrder::Node node = orders_[place].node(layer, v.node);
  const std::uint32_t first = layer.place_of_value(node.begin);
  for (const CornerAt at : lists_.of(list)) {
    const std::uint32_t value =
        layer.stored_value(first + orders_[place].attribute_at(node, at.wedge));
    ActiveTriangles& part = parts_[at.corner.part()];
    std::uint32_t& kept = part.values[tracked_.size() * at.corner.index() + place];
    part.touched.mark_if(at.corner.triangle(), value != kept);
    kept = value;
  }
}

}  // namespace crease
