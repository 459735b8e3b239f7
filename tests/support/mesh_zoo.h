// Small meshes that every invariant is tested on: closed, open, non-manifold, non-orientable,
// degenerate, smooth, faceted, mixed, with several attribute layers. All have normals.
#pragma once

#include "crease/mesh.h"

#include <string>
#include <vector>

namespace crease {

struct ZooMesh {
  std::string name;
  Mesh mesh;
};

std::vector<ZooMesh> mesh_zoo();

// Builders that tests also call on their own. Normals as the name says.
Mesh smooth_sphere(int rings, int segments);            // one normal a vertex
Mesh faceted_sphere(int rings, int segments);           // one normal a triangle
Mesh hard_box(int cells);                               // cells^2 quads a side, one normal a side
Mesh hard_cylinder(int segments, int rings);            // smooth side, flat caps, hard rims
Mesh crossing_walls(int walls, int cells);              // sheets that meet in edges of four triangles
Mesh height_field(int cells);                           // open, smooth, with texture coordinates

}  // namespace crease
