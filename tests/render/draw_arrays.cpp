#include "render/draw_arrays.h"

#include "crease/shading.h"

namespace crease {

namespace {

Vec3f normal_at_corner(const Mesh& mesh, std::size_t corner) {
  const auto n = mesh.normals()->value(mesh.normals()->of_corner[corner]);
  return {n[0], n[1], n[2]};
}

const AttributeLayer* colors_of(const Mesh& mesh) {
  for (const AttributeLayer& layer : mesh.layers) {
    if (layer.role == AttributeRole::Color) return &layer;
  }
  return nullptr;
}

}  // namespace

DrawArrays::DrawArrays(const Mesh& mesh) : materials_(mesh.materials) {
  if (!mesh.positions.empty()) origin_ = mesh.positions[0];
  const ShadingKinds kinds = classify_shading(mesh);
  // SN vertices first, then the others.
  std::vector<std::uint32_t> new_index(mesh.vertex_count());
  for (const VertexKind kind : {VertexKind::SN, VertexKind::NSN}) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      if (kinds.of_vertex[v] != kind) continue;
      new_index[v] = std::uint32_t(positions_.size());
      const Vec3d p = mesh.positions[v] - origin_;
      positions_.push_back({float(p.x), float(p.y), float(p.z)});
    }
    if (kind == VertexKind::SN) vertex_normals_.resize(positions_.size());
  }
  const AttributeLayer* colors = colors_of(mesh);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleKind kind = kinds.of_triangle[t];
    Part& part = kind == TriangleKind::SN ? sn_ : kind == TriangleKind::FN ? fn_ : nsn_;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t vertex = index_of(mesh.triangles[t][c]);
      part.indices.push_back(new_index[vertex]);
      const Vec3f normal = normal_at_corner(mesh, 3 * t + c);
      if (kind == TriangleKind::SN) vertex_normals_[new_index[vertex]] = normal;
      if (kind == TriangleKind::NSN || (kind == TriangleKind::FN && c == 0)) {
        part.normals.push_back(normal);
      }
      if (colors != nullptr) {
        const auto value = colors->value(colors->of_corner[3 * t + c]);
        part.colors.push_back({value[0], value[1], value[2], 1});
      }
    }
    if (!mesh.material_of_triangle.empty()) {
      part.materials.push_back(std::uint32_t(index_of(mesh.material_of_triangle[t])));
    }
  }
}

DrawList DrawArrays::list() const {
  return {.origin = origin_,
          .positions = positions_,
          .vertex_normals = vertex_normals_,
          .sn = sn_.view(),
          .fn = fn_.view(),
          .nsn = nsn_.view(),
          .materials = materials_};
}

}  // namespace crease
