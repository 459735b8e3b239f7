// Open borders that meet but for a rounding error: exporters that transform every face on its own
// leave its corners some millionths away from its neighbours', and the mesh falls into loose
// triangles, each with edges of its own.
//
//   const NearBorders near = find_near_borders(mesh, grid.step);
//   report.welded_vertices += weld_borders(mesh, near);
//   keep_triangles(mesh, proper_triangles(mesh));
#pragma once

#include "crease/mesh.h"

#include <cstddef>
#include <vector>

namespace crease {

struct NearBorders {
  std::vector<VertexId> first;   // per vertex: an earlier one that it is near, or itself. Empty: 0
  std::size_t count = 0;         // those that are near an earlier one
  std::size_t border_count = 0;  // vertices at open borders, or where orientation changes
};

// 2^-22 of the longest side without strays: what floats hardly tell apart, as a sine of 2 pi leaves
// 1.7e-7 of them.
double rounding_of(const Mesh& mesh);

// Vertices at open borders within `distance` of each other, model units; 0: none. Those nearer than
// twice that to another corner of a triangle of theirs are left alone, so that no triangle is lost,
// unless they are within rounding_of(mesh): that is a triangle without area, as at the pole of a
// sphere, whose corners stand at sin(pi) in place of 0 and leave an open ring around nothing. Time
// O(corners) where few vertices are that near each other, memory 20 bytes a vertex while it runs.
NearBorders find_near_borders(const Mesh& mesh, double distance);

// Each becomes the vertex that it is near, where that is; nothing happens where no triangle would
// have three corners then. Returns how many are gone. Attributes stay as they are.
std::size_t weld_borders(Mesh& mesh, const NearBorders& near);

}  // namespace crease
