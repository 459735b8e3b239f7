// What a hierarchy's checks and tests need of every leaf: where it is. Found in one pass from the
// roots down.
#pragma once

#include "crease/mesh_hierarchy.h"

#include <cstddef>
#include <utility>
#include <vector>

namespace crease {

struct WedgeRange {
  std::uint32_t begin = 0, end = 0;
};

// The wedges under every node. The hierarchy's arrays must have the right sizes.
inline std::vector<WedgeRange> wedge_ranges(const VertexHierarchy& h) {
  std::vector<WedgeRange> ranges(h.node_count());
  for (std::uint32_t r = 0; r < h.root_count; ++r) {
    ranges[r] = {static_cast<std::uint32_t>(h.root_wedges[r]),
                 static_cast<std::uint32_t>(h.root_wedges[r + 1])};
  }
  for (std::uint32_t s = 0; s < h.split_count(); ++s) {
    const WedgeRange all = ranges[index_of(h.node_of_split[s])];
    const auto middle = static_cast<std::uint32_t>(h.second_wedge[s]);
    ranges[index_of(h.first_child(SplitId{s}))] = {all.begin, middle};
    ranges[index_of(h.second_child(SplitId{s}))] = {middle, all.end};
  }
  return ranges;
}

inline std::vector<NodeId> leaves_of_wedges(const VertexHierarchy& h,
                                            const std::vector<WedgeRange>& ranges) {
  std::vector<NodeId> leaf_of_wedge(h.wedge_count(), kNoNode);
  for (std::uint32_t n = 0; n < h.node_count(); ++n) {
    if (h.is_split.test(n)) continue;
    for (std::uint32_t w = ranges[n].begin; w < ranges[n].end; ++w) leaf_of_wedge[w] = NodeId{n};
  }
  return leaf_of_wedge;
}

// The lowest node with both below, or kNoNode. Parents have smaller numbers.
inline NodeId lowest_common_ancestor(const VertexHierarchy& h, NodeId a, NodeId b) {
  while (a != b) {
    if (a < b) std::swap(a, b);
    if (h.is_root(a)) return kNoNode;
    a = h.parent(a);
  }
  return a;
}

}  // namespace crease
