// Triangles into patches of bounded size that are near in space, so that parts that do not touch
// can be joined by virtual pairs.
#pragma once

#include "crease/ids.h"
#include "crease/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::simplification {

struct Patches {
  std::vector<std::uint32_t> triangles;  // patch after patch, ascending inside each
  std::vector<std::uint32_t> first;      // patch_count + 1 offsets into `triangles`

  std::size_t count() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t patch) const {
    return std::span(triangles).subspan(first[patch], first[patch + 1] - first[patch]);
  }
};

// A k-d tree over centroids, cut across the longest axis or one that cuts far fewer triangles, at
// `band`-dependent fractions so that the borders of two bands in a row lie elsewhere. What two
// patches share is locked, so a part of no more than `patch_triangles` goes into one, where its
// middle is; `part_of_vertex` has one of a part's vertices for all of them, or is empty: there is
// one part. Depends on the input alone. Time O(n log(n / patch_triangles)), parallel.
Patches partition_triangles(std::span<const Vec3i> positions,
                            std::span<const std::uint32_t> vertices_of_triangle,  // 3 a triangle
                            std::vector<std::uint32_t> triangles, std::uint32_t patch_triangles,
                            int band, std::span<const std::uint32_t> part_of_vertex = {});

}  // namespace crease::simplification
