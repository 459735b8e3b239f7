// A model as what is compared with others: around the origin, with its normals and no other layer,
// material or part.
//
//   const Mesh mesh = normals_alone(std::move(imported->mesh));
#pragma once

#include "crease/mesh.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace crease {

// The middle of the bounding box.
inline Vec3d centre_of(const Mesh& mesh) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3d low{kInf, kInf, kInf}, high{-kInf, -kInf, -kInf};
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return low + (high - low) * 0.5;
}

// `mesh` must have normals.
inline Mesh normals_alone(Mesh mesh) {
  const Vec3d centre = centre_of(mesh);
  for (Vec3d& p : mesh.positions) p = p - centre;
  AttributeLayer normals = std::move(*mesh.normals());
  mesh.layers.clear();
  mesh.layers.push_back(std::move(normals));
  mesh.material_of_triangle.clear();
  mesh.part_of_triangle.clear();
  mesh.materials.clear();
  mesh.parts.clear();
  return mesh;
}

}  // namespace crease
