// The three-part arrays of a mesh that is not progressive.
#include "crease/draw_list.h"

#include "base/assert.h"
#include "crease/shading.h"
#include "runtime/draw_values.h"

#include <algorithm>
#include <array>

namespace crease {

namespace {

struct PartArrays {
  std::vector<std::uint32_t> indices;
  std::vector<Vec3f> normals;
  std::vector<std::uint32_t> materials;
  std::vector<std::array<float, 4>> colors;
  std::vector<std::array<float, 2>> texcoords;

  DrawPart view() const { return {indices, normals, materials, colors, texcoords}; }
};

Vec3d center_of(const Mesh& mesh) {
  if (mesh.positions.empty()) return {};
  Vec3d low = mesh.positions[0], high = low;
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return low + (high - low) * 0.5;
}

Vec3f normal_at(const AttributeLayer& normals, std::size_t corner) {
  const std::span<const float> n = normals.value(normals.of_corner[corner]);
  return {n[0], n[1], n[2]};
}

const AttributeLayer* color_layer(const Mesh& mesh) {
  const auto found =
      std::find_if(mesh.layers.begin(), mesh.layers.end(),
                   [](const AttributeLayer& layer) { return layer.role == AttributeRole::Color; });
  return found == mesh.layers.end() ? nullptr : &*found;
}

}  // namespace

struct MeshDrawArrays::Impl {
  explicit Impl(const Mesh& mesh);
  void add_vertices(const Mesh& mesh, const ShadingKinds& kinds);
  void add_triangle(const Mesh& mesh, std::size_t t, TriangleKind kind);

  Vec3d origin;
  std::vector<Vec3f> positions, vertex_normals;
  std::vector<std::uint32_t> new_of_vertex;
  PartArrays sn, fn, nsn;
  const AttributeLayer* colors = nullptr;     // of the mesh, while the arrays are made
  const AttributeLayer* texcoords = nullptr;  // the same
  std::vector<Material> materials;
  std::vector<ImageFile> images;
};

MeshDrawArrays::Impl::Impl(const Mesh& mesh)
    : origin(center_of(mesh)), materials(mesh.materials), images(mesh.images) {
  CREASE_ASSERT(mesh.normals() != nullptr);
  colors = color_layer(mesh);
  const std::uint32_t painted = drawn_texcoords(mesh.layers);
  if (painted != kNone) texcoords = &mesh.layers[painted];
  const ShadingKinds kinds = classify_shading(mesh);
  add_vertices(mesh, kinds);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    add_triangle(mesh, t, kinds.of_triangle[t]);
  }
}

void MeshDrawArrays::Impl::add_vertices(const Mesh& mesh, const ShadingKinds& kinds) {
  new_of_vertex.resize(mesh.vertex_count());
  for (VertexKind kind : {VertexKind::SN, VertexKind::NSN}) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      if (kinds.of_vertex[v] != kind) continue;
      new_of_vertex[v] = static_cast<std::uint32_t>(positions.size());
      const Vec3d p = mesh.positions[v] - origin;
      positions.push_back(
          {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    if (kind == VertexKind::SN) vertex_normals.resize(positions.size());
  }
  const AttributeLayer& normals = *mesh.normals();
  for (std::size_t corner = 0; corner < normals.of_corner.size(); ++corner) {
    const std::size_t v = new_of_vertex[index_of(mesh.triangles[corner / 3][corner % 3])];
    if (v < vertex_normals.size()) vertex_normals[v] = normal_at(normals, corner);
  }
}

void MeshDrawArrays::Impl::add_triangle(const Mesh& mesh, std::size_t t, TriangleKind kind) {
  PartArrays& part = kind == TriangleKind::SN ? sn : kind == TriangleKind::FN ? fn : nsn;
  const std::size_t normal_count = kind == TriangleKind::SN ? 0 : kind == TriangleKind::FN ? 1 : 3;
  for (std::size_t c = 0; c < 3; ++c) {
    part.indices.push_back(new_of_vertex[index_of(mesh.triangles[t][c])]);
    if (c < normal_count) part.normals.push_back(normal_at(*mesh.normals(), 3 * t + c));
    if (colors != nullptr) {
      part.colors.push_back(draw_color(colors->value(colors->of_corner[3 * t + c])));
    }
    if (texcoords != nullptr) {
      const std::span<const float> uv = texcoords->value(texcoords->of_corner[3 * t + c]);
      part.texcoords.push_back({uv[0], uv[1]});
    }
  }
  if (!mesh.material_of_triangle.empty()) {
    part.materials.push_back(static_cast<std::uint32_t>(index_of(mesh.material_of_triangle[t])));
  }
}

MeshDrawArrays::MeshDrawArrays(const Mesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
MeshDrawArrays::~MeshDrawArrays() = default;
MeshDrawArrays::MeshDrawArrays(MeshDrawArrays&&) noexcept = default;

DrawList MeshDrawArrays::draw_list() const {
  DrawList list;
  list.origin = impl_->origin;
  list.positions = impl_->positions;
  list.vertex_normals = impl_->vertex_normals;
  list.sn = impl_->sn.view();
  list.fn = impl_->fn.view();
  list.nsn = impl_->nsn.view();
  list.materials = impl_->materials;
  list.images = impl_->images;
  return list;
}

}  // namespace crease
