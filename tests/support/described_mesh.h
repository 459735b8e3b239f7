// A mesh as the multiset of its triangles: no numbers, but everything that one can see. Two meshes
// are the same iff their descriptions are equal; corners of a vertex share an attribute iff its
// value is the same.
#pragma once

#include "crease/mesh.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace crease {

using DescribedMesh = std::vector<std::vector<std::uint64_t>>;

// What nobody sees has no normal. Up to rounding: it is on the grid that three points lie in a row.
inline bool has_no_area(const Mesh& mesh, const Triangle& t) {
  const Vec3d& p = mesh.positions[index_of(t[0])];
  const Vec3d u = mesh.positions[index_of(t[1])] - p, v = mesh.positions[index_of(t[2])] - p;
  return length(cross(u, v)) <= 1e-9 * (dot(u, u) + dot(v, v));
}

inline DescribedMesh described(const Mesh& mesh) {
  DescribedMesh all;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::vector<std::vector<std::uint64_t>> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      std::vector<std::uint64_t>& corner = corners.emplace_back();
      const Vec3d& p = mesh.positions[index_of(mesh.triangles[t][c])];
      for (int k = 0; k < 3; ++k) corner.push_back(std::bit_cast<std::uint64_t>(p[k] + 0.0));
      for (const AttributeLayer& layer : mesh.layers) {
        if (layer.role == AttributeRole::Normal && has_no_area(mesh, mesh.triangles[t])) continue;
        for (const float f : layer.value(layer.of_corner[3 * t + c])) {
          corner.push_back(std::bit_cast<std::uint32_t>(f + 0.0f));
        }
      }
    }
    // Turned so that it comes first; corners may be equal, so all three ways are looked at.
    auto least = corners;
    for (int turn = 0; turn < 2; ++turn) {
      std::rotate(corners.begin(), corners.begin() + 1, corners.end());
      least = std::min(least, corners);
    }
    std::vector<std::uint64_t>& triangle = all.emplace_back();
    if (!mesh.material_of_triangle.empty()) {
      triangle.push_back(index_of(mesh.material_of_triangle[t]));
    }
    if (!mesh.part_of_triangle.empty()) triangle.push_back(index_of(mesh.part_of_triangle[t]));
    for (const auto& corner : least) triangle.insert(triangle.end(), corner.begin(), corner.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace crease
