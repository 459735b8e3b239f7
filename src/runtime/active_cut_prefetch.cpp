// The memory of moves to come, on its way before they need it.
#include "runtime/active_cut.h"

namespace crease {

void ActiveCut::prefetch_split(std::uint32_t slot, SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  __builtin_prefetch(&vertices_[slot]);
  h_.deltas.prefetch(3 * (first - h_.root_count));
  if (!is_large_) return;
  __builtin_prefetch(&following_of_slot_[slot]);
  h_.second_wedge.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (first - h_.root_count) + 5);
  h_.is_split.prefetch(first);
}

void ActiveCut::prefetch_split_further(SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  __builtin_prefetch(&h_.bounds[index_of(s)]);
  const WedgeId middle = h_.second_wedge[index_of(s)];
  if (is_large_ && index_of(middle) < h_.wedge_count()) {
    map_.prefetch(middle);
    map_.prefetch_slot(middle);
  }
  const std::size_t below = h_.is_split.rank(first);
  if (below < h_.bounds.size()) __builtin_prefetch(&h_.bounds[below]);
}

void ActiveCut::prefetch_merge(std::uint32_t slot, SplitId s) const {
  __builtin_prefetch(&vertices_[slot]);
  h_.deltas.prefetch(3 * (index_of(h_.first_child(s)) - h_.root_count));
  if (!is_large_) return;
  h_.second_wedge.prefetch(index_of(s));
  h_.node_of_split.prefetch(index_of(s));
}

void ActiveCut::prefetch_merge_further(SplitId s) const {
  const NodeId node = h_.node_of_split[index_of(s)];
  if (is_large_) {
    const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
    if (middle < h_.wedge_count()) {
      map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle)});
      map_.prefetch_slot(WedgeId{static_cast<std::uint32_t>(middle)});  // if it is one
    }
    if (middle > 0) map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle - 1)});
    h_.is_split.prefetch(index_of(node));
  }
  if (h_.is_root(node)) return;
  const SplitId above = h_.split_above(node);
  __builtin_prefetch(&h_.bounds[index_of(above)]);
  __builtin_prefetch(&h_.bounds[index_of(s)]);
  h_.deltas.prefetch(3 * (index_of(node) - h_.root_count));
}

void ActiveCut::prefetch_begins(SplitId s) const {
  if (!is_large_) return;
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle == 0) return;
  map_.prefetch_slot(map_.begin_before(WedgeId{static_cast<std::uint32_t>(middle - 1)}));
}

ActiveCut::Children ActiveCut::prefetch_children(SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle == 0 || middle >= h_.wedge_count()) return {};
  const Children found{map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle - 1)}),
                       map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle)})};
  for (const std::uint32_t slot : {found.first, found.second}) {
    __builtin_prefetch(&vertices_[slot]);
    __builtin_prefetch(&following_of_slot_[slot]);
  }
  return found;
}

void ActiveCut::prefetch_normals(NodeId node) const {
  if (normal_layer_ == kNone || node == kNoNode) return;
  hierarchy_.layers[normal_layer_].attribute_ranges.prefetch(index_of(node));
}

void ActiveCut::prefetch_normals_further(NodeId node) const {
  if (!is_large_ || normal_layer_ == kNone || node == kNoNode) return;
  hierarchy_.layers[normal_layer_].attribute_ranges.prefetch_further(index_of(node));
}

void ActiveCut::prefetch_normal(std::uint32_t attribute) const {
  if (normal_layer_ == kNone) return;
  const AttributeHierarchy& layer = hierarchy_.layers[normal_layer_];
  if (layer.has_value.size() > 0) {
    layer.has_value.prefetch(attribute);
  } else if (!layer.value_of_attribute.empty()) {
    layer.value_of_attribute.prefetch(attribute);
  }
}

// Of the corners in born_ that have to look up theirs, step by step for all of them.
void ActiveCut::prefetch_varying_values() {
  for (std::size_t i = 0; i < tracked_.size(); ++i) {
    const AttributeHierarchy& layer = hierarchy_.layers[tracked_[i]];
    if (layer.constant_of_wedge.empty()) continue;
    varying_.clear();
    for (const Born& b : born_) {
      for (std::size_t k = 0; k < 3; ++k) {
        const ActiveVertex& v = vertices_[b.slots[k]];
        const bool varies = constant_at(i, b.wedges[k]) == kNone && has_several(i, v);
        if (varies) varying_.push_back(v.node);
      }
    }
    for (const NodeId n : varying_) {
      layer.attribute_ranges.prefetch(index_of(n));
      h_.is_split.prefetch(index_of(n));
      if (!h_.is_root(n)) h_.second_wedge.prefetch(index_of(h_.split_above(n)));
    }
    for (const NodeId n : varying_) layer.attribute_ranges.prefetch_further(index_of(n));
    if (layer.has_value.size() == 0 || layer.value_of_attribute.empty()) continue;
    for (const NodeId n : varying_) {
      layer.has_value.prefetch(layer.attribute_ranges.begin(index_of(n)));
    }
    for (const NodeId n : varying_) {
      const std::uint32_t first = layer.attribute_ranges.begin(index_of(n));
      layer.value_of_attribute.prefetch(layer.place_of_value(first));
    }
  }
}

void ActiveCut::prefetch_corners(std::uint32_t slot) const {
  // So many whatever there are: those beyond the end were there once, and do no harm.
  constexpr std::size_t kMost = 6;
  const CornerList& list = vertices_[slot].corners;
  if (!list.is_own()) return;
  for (std::size_t i = 0; i < kMost; ++i) {
    const CornerRef corner = list.refs[i];
    __builtin_prefetch(parts_[corner.part()].slots.data() + 3 * std::size_t(corner.triangle()));
  }
}

}  // namespace crease
