#include "io/glb_materials.h"

#include "io/images.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace crease {

std::vector<std::size_t> GlbMaterials::add(const Mesh& mesh) {
  const bool has_texcoords = std::ranges::any_of(mesh.layers, [](const AttributeLayer& layer) {
    return layer.role == AttributeRole::TexCoord && layer.dimension == 2;
  });
  std::vector<std::size_t> result;
  for (const Material& material : mesh.materials) {
    const auto [begin, end] = by_name_.equal_range(material.name);
    const auto same = std::find_if(
        begin, end, [&](const auto& entry) { return materials_[entry.second] == material; });
    result.push_back(same == end ? materials_.size() : same->second);
    if (same != end) continue;
    by_name_.emplace(material.name, materials_.size());
    materials_.push_back(material);
    const ImageFile* image = find_image(mesh.images, material.base_color_texture);
    const bool can_be_inside = image != nullptr && !image_type(*image->bytes).empty();
    if (!has_texcoords || !can_be_inside || find_image(images_, image->name) != nullptr) continue;
    images_.push_back(*image);
  }
  return result;
}

void GlbMaterials::write(nlohmann::ordered_json& json, nlohmann::ordered_json& views,
                         std::size_t& length) const {
  for (const Material& material : materials_) {
    json["materials"].push_back(material_json(material));
  }
  for (const ImageFile& image : images_) {
    const std::size_t index = json["images"].size();
    json["images"].push_back({{"name", image.name},
                              {"mimeType", image_type(*image.bytes)},
                              {"bufferView", views.size()}});
    json["textures"].push_back({{"source", index}});
    views.push_back({{"buffer", 0}, {"byteOffset", length}, {"byteLength", image.bytes->size()}});
    length += image.bytes->size();
  }
}

// The name of a texture that is not inside goes into `extras`, where the reader finds it again: an
// image that is not there would make the file invalid.
nlohmann::ordered_json GlbMaterials::material_json(const Material& material) const {
  std::array<float, 4> color = material.base_color;
  for (float& c : color) c = std::clamp(c, 0.0f, 1.0f);
  nlohmann::ordered_json model = {
      {"baseColorFactor", color}, {"metallicFactor", 0}, {"roughnessFactor", 1}};
  nlohmann::ordered_json entry = nlohmann::ordered_json::object();
  if (!material.name.empty()) entry["name"] = material.name;
  const ImageFile* image = find_image(images_, material.base_color_texture);
  if (image != nullptr) model["baseColorTexture"] = {{"index", image - images_.data()}};
  entry["pbrMetallicRoughness"] = std::move(model);
  if (material.alpha_cutoff > 0) {
    entry["alphaMode"] = "MASK";
    entry["alphaCutoff"] = material.alpha_cutoff;
  } else if (color[3] < 1 || material.is_blended) {
    entry["alphaMode"] = "BLEND";
  }
  if (material.double_sided) entry["doubleSided"] = true;
  if (image == nullptr && !material.base_color_texture.empty()) {
    entry["extras"] = {{"base_color_texture", material.base_color_texture}};
  }
  return entry;
}

}  // namespace crease
