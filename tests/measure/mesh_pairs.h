// Pairs of meshes that what measures two of them is tested on.
#pragma once

#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <array>
#include <cstddef>
#include <vector>

namespace crease {

inline Mesh moved(Mesh mesh, const Vec3d& offset, double scale = 1) {
  for (Vec3d& p : mesh.positions) p = p * scale + offset;
  return mesh;
}

// Each mesh of the zoo with another one.
template <typename Visit>
void for_zoo_pairs(Visit visit) {
  const std::vector<ZooMesh> zoo = mesh_zoo();
  for (std::size_t i = 0; i < zoo.size(); ++i) {
    const ZooMesh &a = zoo[i], &b = zoo[(i * 5 + 3) % zoo.size()];
    if (a.mesh.triangle_count() == 0 || b.mesh.triangle_count() == 0) continue;
    CAPTURE(a.name);
    CAPTURE(b.name);
    visit(a.mesh, b.mesh);
  }
}

// Of flat triangles on a coarse grid, so that some touch, cross and coincide; not empty. Within
// rc::check() alone.
inline Mesh any_triangles() {
  const auto corners = *rc::gen::nonEmpty<std::vector<std::array<int, 9>>>(
      rc::gen::container<std::vector<std::array<int, 9>>>(
          rc::gen::container<std::array<int, 9>>(rc::gen::inRange(-20, 21))));
  MeshBuilder b;
  for (const std::array<int, 9>& x : corners) {
    b.flat_triangle({b.vertex({x[0] / 10.0, x[1] / 10.0, x[2] / 10.0}),
                     b.vertex({x[3] / 10.0, x[4] / 10.0, x[5] / 10.0}),
                     b.vertex({x[6] / 10.0, x[7] / 10.0, x[8] / 10.0})});
  }
  return b.take();
}

}  // namespace crease
