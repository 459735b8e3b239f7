// The memory of moves to come, on its way before they need it.
#include "runtime/active_cut.h"

namespace crease {

void ActiveCut::prefetch_split(std::uint32_t slot, SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  __builtin_prefetch(&vertices_[slot]);
  __builtin_prefetch(&following_of_slot_[slot]);
  h_.second_wedge.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (first - h_.root_count));
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
  h_.second_wedge.prefetch(index_of(s));
  h_.node_of_split.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (index_of(h_.first_child(s)) - h_.root_count));
}

void ActiveCut::prefetch_merge_further(SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle < h_.wedge_count()) {
    map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle)});
    map_.prefetch_slot(WedgeId{static_cast<std::uint32_t>(middle)});  // if it is one
  }
  if (middle > 0) map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle - 1)});
  const NodeId node = h_.node_of_split[index_of(s)];
  h_.is_split.prefetch(index_of(node));
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
