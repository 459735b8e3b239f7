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

// As children(), but what is not there yet is not waited for.
void ActiveCut::prefetch_siblings(SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle == 0 || middle >= h_.wedge_count()) return;
  prefetch_vertex(map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle)}));
  prefetch_vertex(map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle - 1)}));
}

// The third vertices of the triangles that collapse.
void ActiveCut::prefetch_siblings_further(SplitId s) const {
  const std::size_t middle = index_of(h_.second_wedge[index_of(s)]);
  if (middle == 0 || middle >= h_.wedge_count()) return;
  const std::uint32_t second = map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle)});
  const std::uint32_t first = map_.slot_at(WedgeId{static_cast<std::uint32_t>(middle - 1)});
  for (const CornerAt at : corners_of(second)) {
    const std::uint32_t* const of =
        &parts_[at.corner.part()].slots[3 * std::size_t(at.corner.triangle())];
    if ((of[0] == first) | (of[1] == first) | (of[2] == first)) {
      prefetch_vertex(of[0] ^ of[1] ^ of[2] ^ first ^ second);
    }
  }
}

// The third vertices of what a split brings.
void ActiveCut::prefetch_born(std::uint32_t slot, SplitId s) const {
  const WedgeId begin = vertices_[slot].begin, end = vertices_[slot].end;
  const TriangleRange born = h_.triangles_of(s);
  const std::uint32_t last = std::min(born.end, born.begin + 4);
  for (std::uint32_t t = born.begin; t < last; ++t) {
    for (const WedgeId wedge : h_.triangles[t]) {
      if (wedge < begin || wedge >= end) prefetch_vertex(map_.slot_at(wedge));
    }
  }
}

void ActiveCut::prefetch_corners(std::uint32_t slot) const {
  for (const CornerAt at : corners_of(slot)) {
    __builtin_prefetch(&parts_[at.corner.part()].slots[3 * std::size_t(at.corner.triangle())]);
  }
}

}  // namespace crease
