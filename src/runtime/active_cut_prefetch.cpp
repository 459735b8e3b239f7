// The memory of moves to come, on its way before they need it.
#include "runtime/active_cut.h"

namespace crease {

void ActiveCut::prefetch_split(std::uint32_t slot, SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  prefetch_vertex(slot);
  h_.second_wedge.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (first - h_.root_count));
  h_.deltas.prefetch(3 * (first - h_.root_count) + 5);
  h_.is_split.prefetch(first);
  h_.triangle_ranges.prefetch(index_of(s) + 1);
  if (normal_layer_ != kNone) hierarchy_.layers[normal_layer_].attribute_ranges.prefetch(first);
}

void ActiveCut::prefetch_split_further(std::uint32_t slot, SplitId s) const {
  const std::size_t first = index_of(h_.first_child(s));
  __builtin_prefetch(&h_.bounds[index_of(s)]);
  const std::size_t below = h_.is_split.rank(first);
  if (below < h_.bounds.size()) __builtin_prefetch(&h_.bounds[below]);
  const TriangleRange born = h_.triangles_of(s);
  if (born.begin < born.end) h_.triangles.of_corner.prefetch(3 * std::size_t(born.begin));
  if (vertices_[slot].split == s) prefetch_corners(slot);
}

void ActiveCut::prefetch_merge(std::uint32_t slot, SplitId s) const {
  prefetch_vertex(slot);
  h_.second_wedge.prefetch(index_of(s));
  h_.node_of_split.prefetch(index_of(s));
  h_.deltas.prefetch(3 * (index_of(h_.first_child(s)) - h_.root_count));
}

void ActiveCut::prefetch_merge_further(std::uint32_t slot, SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle < h_.wedge_count()) map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle)});
  if (middle > 0) map_.prefetch(WedgeId{static_cast<std::uint32_t>(middle - 1)});
  prefetch_corners(slot);
  const NodeId node = h_.node_of_split[index_of(s)];
  h_.is_split.prefetch(index_of(node));
  if (h_.is_root(node)) return;
  const SplitId above = h_.split_above(node);
  __builtin_prefetch(&h_.bounds[index_of(above)]);
  __builtin_prefetch(&h_.bounds[index_of(s)]);
  h_.deltas.prefetch(3 * (index_of(node) - h_.root_count));
}

void ActiveCut::prefetch_corners(std::uint32_t slot) const {
  // So many whatever there are: those beyond the end were there once, and do no harm.
  constexpr std::size_t kMost = 8;
  const CornerList& list = vertices_[slot].corners;
  if (!list.is_own()) return;
  for (std::size_t i = 0; i < kMost; ++i) {
    const CornerRef corner = list.refs[i];
    __builtin_prefetch(parts_[corner.part()].slots.data() + 3 * std::size_t(corner.triangle()));
  }
}

}  // namespace crease
