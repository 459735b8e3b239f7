#pragma once

#include "support/mesh_zoo.h"

namespace crease {

// Four blocks of houses, in a left and a right part.
inline Mesh two_part_city() {
  Mesh mesh = city_blocks(2, 2);
  mesh.parts = {"left", "right"};
  mesh.part_of_triangle.clear();
  for (const Triangle& t : mesh.triangles) {
    const bool is_left = mesh.positions[index_of(t[0])].x < 1.5;
    mesh.part_of_triangle.push_back(PartId(is_left ? 0u : 1u));
  }
  return mesh;
}

}  // namespace crease
