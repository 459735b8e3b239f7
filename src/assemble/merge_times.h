// When two vertices become one: their lowest common ancestor, by the contraction that makes it.
//
// Union by size without path compression: a link tells the time it was made, and links on the way
// up are ever younger, so the last one on the way between two vertices is the answer. The way is at
// most log2(vertices) long, however deep the vertex hierarchy itself is.
#pragma once

#include "crease/contraction.h"
#include "crease/ids.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease {

inline constexpr std::uint32_t kNever = kNone;  // later than any contraction

class MergeTimes {
 public:
  MergeTimes(std::size_t vertex_count, const std::vector<Contraction>& contractions)
      : links_(vertex_count) {
    std::vector<std::uint32_t> size(vertex_count, 1);
    for (std::uint32_t v = 0; v < vertex_count; ++v) links_[v] = {v, kNever};
    // The set of a vertex that the sequence names. Slots stand for sets: the representative of one
    // is kept per slot.
    std::vector<std::uint32_t> set_of_slot(vertex_count);
    for (std::uint32_t v = 0; v < vertex_count; ++v) set_of_slot[v] = v;
    for (std::uint32_t i = 0; i < contractions.size(); ++i) {
      std::uint32_t small = set_of_slot[index_of(contractions[i].removed)];
      std::uint32_t large = set_of_slot[index_of(contractions[i].kept)];
      if (size[small] > size[large]) std::swap(small, large);
      links_[small] = {large, i};
      size[large] += size[small];
      set_of_slot[index_of(contractions[i].kept)] = large;
    }
  }

  // The contraction that makes one of a and b, which differ; or kNever.
  std::uint32_t of(VertexId a, VertexId b) const {
    auto x = static_cast<std::uint32_t>(index_of(a)), y = static_cast<std::uint32_t>(index_of(b));
    std::uint32_t time = 0;
    while (x != y) {
      if (links_[x].time > links_[y].time) std::swap(x, y);
      time = links_[x].time;
      if (time == kNever) return kNever;
      x = links_[x].to;
    }
    return time;
  }

 private:
  struct Link {
    std::uint32_t to;
    std::uint32_t time;
  };
  std::vector<Link> links_;
};

}  // namespace crease
