// Shading kinds: where the normal of a triangle corner is stored (DB03, section 3).
//
//   ShadingKinds kinds = classify_shading(mesh);
//   std::size_t smooth_count = std::ranges::count(kinds.of_vertex, VertexKind::SN);
#pragma once

#include "crease/mesh.h"

#include <cstdint>
#include <vector>

namespace crease {

enum class VertexKind : std::uint8_t {
  SN,   // shared normal: all corners at the vertex use one normal
  NSN,  // not shared
};

// A triangle has the first kind that fits.
enum class TriangleKind : std::uint8_t {
  SN,   // its three vertices are SN; it stores no normal
  FN,   // its three corners share one normal; it stores one
  NSN,  // it stores three
};

struct ShadingKinds {
  std::vector<VertexKind> of_vertex;      // vertex_count values
  std::vector<TriangleKind> of_triangle;  // triangle_count values
};

// Sorts every vertex and triangle by kind. Two normals are shared iff their indices are equal, so
// this compares no floats. Needs a normal layer. An isolated vertex is SN.
// Time O(corners), memory 1 byte per vertex and per triangle. Threads: pure, call from any.
[[nodiscard]] ShadingKinds classify_shading(const Mesh& mesh);

}  // namespace crease
