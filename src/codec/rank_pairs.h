// Between which two vertices of its ring a vertex is likely to be split. Doubles without fused
// products, as in predict_position.h.
#pragma once

#include "crease/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

struct RingVertex {
  Vec3d position{};      // from the centre, grid units
  double triangles = 0;  // at the vertex
};

struct RingPair {
  std::uint32_t first = 0, last = 0;  // first < last
  double score = 0;
};

// All pairs of a closed ring, likeliest first. Time O(n^2 log n) for n vertices.
void rank_pairs(std::span<const RingVertex> ring, std::vector<RingPair>& pairs);

}  // namespace crease::codec
