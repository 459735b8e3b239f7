// What a renderer that keeps copies of the DrawList arrays has to fetch again after a change.
//
//   for (Range r : progressive_mesh.changes().positions) upload(r);
#pragma once

#include <cstdint>
#include <vector>

namespace crease {

struct Range {  // [first, first + count), in elements
  std::uint32_t first = 0, count = 0;
};

// Sorted, disjoint, in elements of the arrays as they are now. Copies are taken whole before the
// first change; then the ranges of every change keep the active part of them right. Triangles that
// come back are in a range only if they changed meanwhile; the new counts need no upload. Where an
// AdaptiveMesh has materials, they change with the indices.
struct DrawChanges {
  std::vector<Range> positions, vertex_normals;
  std::vector<Range> sn_indices, fn_indices, nsn_indices;  // in triangles
  std::vector<Range> fn_normals, nsn_normals;              // in triangles
  // Of colours and of texture coordinates, in triangles.
  std::vector<Range> sn_colors, fn_colors, nsn_colors;
};

}  // namespace crease
