// Small meshes that every invariant is tested on: closed, open, non-manifold, non-orientable,
// degenerate, empty, smooth, faceted, mixed, with several attribute layers. All have normals.
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
Mesh smooth_sphere(int rings, int segments);   // radius 1; one normal a vertex
Mesh faceted_sphere(int rings, int segments);  // radius 1; one normal a triangle
Mesh hard_box(int cells);                      // 0..1; cells^2 quads a side, one normal a side
Mesh hard_cylinder(int segments, int rings);  // radius 1, z 0..2; smooth side, flat caps, hard rims
// `walls` sheets across x and as many across y, one unit apart and 1 high, cells^2 quads a unit;
// one normal a sheet. They share the vertices of their joints: edges of four triangles.
Mesh crossing_walls(int walls, int cells);
Mesh height_field(int cells);                 // 0..1; open, smooth, with texture coordinates
Mesh torus(int rings, int segments);          // radii 2 and 0.75; one normal a vertex
Mesh gear(int teeth);                         // every flank flat, no two flanks share a normal
Mesh bevelled_box();                          // flat sides, soft bevels: every vertex SN
Mesh noisy_box(int cells, double noise_deg);  // hard_box, each corner's normal off by up to that
Mesh city_blocks(int blocks, int cells);      // blocks^2 disconnected hard boxes of several heights
Mesh sector_fan(int sectors, int rings);      // flat sectors that all meet at vertex 0
Mesh cone(int segments, int rings);           // smooth side, a normal per segment at the tip
Mesh moebius_strip(int segments);             // folded along its middle: a crease that meets itself

}  // namespace crease
