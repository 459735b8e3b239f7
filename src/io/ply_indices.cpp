#include "io/ply_indices.h"

#include "io/ply_names.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace crease {

namespace {

// Of each triangle, by its face's value; of those that are not below `count` `other`, or none has.
template <typename Id>
std::vector<Id> ids_of_triangles(const RawMesh& mesh, const RawLayer& layer, std::size_t count,
                                 std::optional<Id> other = {}) {
  std::vector<Id> ids;
  for (std::uint32_t f : mesh.face_of_triangle) {
    const float x = layer.values[f];
    const bool fits = x >= 0 && x < static_cast<float>(count);
    if (!fits && !other) return {};
    ids.push_back(fits ? Id{static_cast<std::uint32_t>(x)} : *other);
  }
  return ids;
}

}  // namespace

bool take_index(const RawLayer& layer, std::span<const std::string> comments, RawMesh& mesh) {
  if (layer.name == kPartIndex) {
    std::vector<std::string> parts = parts_in(comments);
    mesh.part_of_triangle = ids_of_triangles<PartId>(mesh, layer, parts.size());
    if (mesh.part_of_triangle.empty()) return false;
    mesh.parts = std::move(parts);
    return true;
  }
  const bool is_material = layer.name == kMaterialIndex;
  if (!is_material && layer.name != kTextureIndex) return false;
  if (!is_material && !mesh.materials.empty()) return true;
  std::vector<Material> materials = is_material ? materials_in(comments) : textures_in(comments);
  // A face without a texture has MeshLab's -1.
  const MaterialId bare{static_cast<std::uint32_t>(materials.size())};
  mesh.material_of_triangle = ids_of_triangles<MaterialId>(
      mesh, layer, materials.size(),
      is_material || materials.empty() ? std::nullopt : std::optional(bare));
  if (std::ranges::count(mesh.material_of_triangle, bare) > 0) materials.emplace_back();
  if (mesh.material_of_triangle.empty()) return false;
  mesh.materials = std::move(materials);
  return true;
}

void take_only_texture(std::span<const std::string> comments, RawMesh& mesh) {
  if (!mesh.materials.empty()) return;
  std::vector<Material> textures = textures_in(comments);
  if (textures.size() != 1) return;
  mesh.materials = std::move(textures);
  mesh.material_of_triangle.assign(mesh.triangles.size(), MaterialId{0});
}

}  // namespace crease
