// Islands, what is painted on a face, stay whole or go: windows in a wall that have lost a corner
// each are worse to look at than fewer windows.
//
// An island is a flat region of one category (material and part) and of few triangles, in a plane
// with larger regions of others, or a little behind or before it. A contraction that takes a good
// share of what is lost if the island vanishes breaks it: then all the rest goes as well. The
// simplifier decides so, and who puts the contractions of a file in order keeps them together.
#pragma once

#include "crease/vec.h"

#include <cstddef>

namespace crease {

inline constexpr std::size_t kMostOfIsland = 36;  // triangles

// Whether triangles with these normals are parallel: up to a degree, since grids round.
inline bool are_parallel(const Vec3d& a, const Vec3d& b) {
  return dot(a, b) >= 0.99985;
}

// Whether a point so far from an island's plane, or from one of its triangles, of this area is no
// farther than windows are set back.
inline bool is_in_plane(double away, double area) {
  constexpr double kMostDepth = 0.4;  // of the root of the area
  return away * away <= kMostDepth * kMostDepth * area;
}

}  // namespace crease
