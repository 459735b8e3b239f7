// A triangle as a glTF, and looking at what was imported of one.
#pragma once

#include "crease/import.h"
#include "io/gltf_builder.h"

#include <algorithm>
#include <string>
#include <vector>

namespace crease {

inline const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// One triangle in the plane z = 0, facing +z, in one node.
inline GltfBuilder one_triangle() {
  GltfBuilder b;
  b.primitive({{"POSITION", b.add(kTriangle, "VEC3")}});
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

inline Vec3d corner(const Mesh& mesh, std::size_t t, std::size_t c) {
  return mesh.positions[index_of(mesh.triangles[t][c])];
}

inline Vec3d normal_at(const Mesh& mesh, std::size_t t, std::size_t c) {
  const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + c]);
  return {n[0], n[1], n[2]};
}

inline bool has_note(const ImportReport& report, const std::string& words) {
  return std::ranges::any_of(report.notes,
                             [&](const auto& n) { return n.find(words) != std::string::npos; });
}

}  // namespace crease
