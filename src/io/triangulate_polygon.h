// One planar-ish polygon with holes, cut into triangles.
//
//   std::vector<Vec3d> points = outer;                   // then the holes' points, ring by ring
//   const std::uint32_t hole_starts[] = {4};             // the first hole begins at points[4]
//   PolygonTriangles cut = triangulate_polygon(points, hole_starts);
//
// Ear clipping on the polygon's projection along the dominant axis of its Newell normal, with exact
// integer predicates on a grid of 2^29 steps a side. Holes are joined to the outer ring by bridges.
// Every point is kept as a corner, collinear ones too, so that no T-junction arises against the
// neighbours of the polygon.
#pragma once

#include "crease/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct PolygonTriangles {
  // Indices into the points given; oriented like the outer ring. At most points - 2 + 2 * holes;
  // fewer where points repeat, since triangles with two equal points are left out.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // True if the polygon crosses itself or its holes lie outside, so that some part had to be cut as
  // a fan or a bridge laid across: triangles may overlap or turn over there.
  bool fanned = false;
};

// The orientation of hole rings does not matter. Fewer than three points give no triangle. Finite
// points are expected. Time O(n) to O(n^1.5) on ordinary polygons, bounded on all: past a budget of
// 5e8 steps (two seconds) the rest is cut as a fan.
PolygonTriangles triangulate_polygon(std::span<const Vec3d> points,
                                     std::span<const std::uint32_t> hole_starts = {});

// The Newell normal of a ring: its length is twice the area, its direction the side from which the
// ring runs counter-clockwise.
Vec3d newell_normal(std::span<const Vec3d> ring);

}  // namespace crease
