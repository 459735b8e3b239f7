#include "crease/shading.h"

#include "base/assert.h"

namespace crease {

ShadingKinds classify_shading(const Mesh& mesh) {
  const AttributeLayer* normals = mesh.normals();
  CREASE_ASSERT(normals != nullptr);
  const std::vector<AttributeId>& normal_of_corner = normals->of_corner;

  ShadingKinds kinds;
  kinds.of_vertex.assign(mesh.vertex_count(), VertexKind::SN);
  std::vector<AttributeId> first_normal(mesh.vertex_count(), kNoAttribute);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t v = index_of(mesh.triangles[t][c]);
      const AttributeId normal = normal_of_corner[3 * t + c];
      if (first_normal[v] == kNoAttribute) first_normal[v] = normal;
      if (first_normal[v] != normal) kinds.of_vertex[v] = VertexKind::NSN;
    }
  }

  kinds.of_triangle.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    bool all_shared = true;
    for (VertexId v : mesh.triangles[t]) {
      all_shared = all_shared && kinds.of_vertex[index_of(v)] == VertexKind::SN;
    }
    const AttributeId* normal = &normal_of_corner[3 * t];
    const bool one_normal = normal[0] == normal[1] && normal[1] == normal[2];
    kinds.of_triangle.push_back(all_shared   ? TriangleKind::SN
                                : one_normal ? TriangleKind::FN
                                             : TriangleKind::NSN);
  }
  return kinds;
}

}  // namespace crease
