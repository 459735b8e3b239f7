#include "io/gltf_materials.h"

#include "io/losses.h"
#include "io/text.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace crease {

namespace {

constexpr std::size_t kRepeat = 10497, kNearest = 9728;  // samplers (5.26)
constexpr const char* kOlderModel = "KHR_materials_pbrSpecularGlossiness";

bool has(const Json& object, const char* key) {
  return at(object, key).is_object();
}

bool is_black(const Json& color) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (as_number(at(color, k), 0) > 0) return false;
  }
  return true;
}

// A material here is neither metallic nor anything but rough, and so is one that is written.
bool is_plain(const Json& model) {
  return as_number(at(model, "metallicFactor"), 1) == 0 &&
         as_number(at(model, "roughnessFactor"), 1) == 1 && !has(model, "metallicRoughnessTexture");
}

void count_texture_losses(const Json& json, const Json& texture_info, Losses& losses) {
  const auto index = as_index(at(texture_info, "index"));
  if (!index) return;
  const auto sampler = as_index(at(at(at(json, "textures"), *index), "sampler"));
  if (!sampler) return;
  const Json& entry = at(at(json, "samplers"), *sampler);
  const auto wraps = [&](const char* key) {
    return as_index(at(entry, key)).value_or(kRepeat) == kRepeat;
  };
  losses.add("wrapS or wrapT, which become REPEAT", !wraps("wrapS") || !wraps("wrapT"));
  losses.add("magFilter NEAREST", as_index(at(entry, "magFilter")) == kNearest);
}

void count_losses(const Json& json, const Json& entry, Losses& losses) {
  const Json& extensions = at(entry, "extensions");
  const Json& model = at(entry, "pbrMetallicRoughness");
  const bool has_other_model = has(extensions, "KHR_materials_unlit") ||
                               (!model.is_object() && (has(extensions, kOlderModel) ||
                                                       has(extensions, "KHR_techniques_webgl")));
  losses.add("metallic and roughness", !has_other_model && !is_plain(model));
  losses.add("normalTexture", has(entry, "normalTexture"));
  losses.add("occlusionTexture", has(entry, "occlusionTexture"));
  losses.add("emission", !is_black(at(entry, "emissiveFactor")) && !shows_emission(entry));
  for (auto it = extensions.begin(); extensions.is_object() && it != extensions.end(); ++it) {
    losses.add(in_quotes(it.key()), true);
  }
  count_texture_losses(json, base_color_texture(entry), losses);
}

// glTF compares the product of both alphas (3.9.4).
float cutoff_of_texture(const Json& cutoff, float factor) {
  constexpr float kAllHoles = 2;  // no alpha is as large
  const auto least = static_cast<float>(std::max(as_number(cutoff, 0.5), 0.0));
  if (least == 0) return 0;
  return least < kAllHoles * factor ? least / factor : kAllHoles;
}

Material read_material(const Json& entry, std::size_t index, GltfImages& images) {
  Material material;
  material.name = as_text(at(entry, "name"));
  if (material.name.empty()) material.name = "material " + std::to_string(index);
  const Json* model = &at(entry, "pbrMetallicRoughness");
  const char* factor = "baseColorFactor";
  const Json& older = at(at(entry, "extensions"), kOlderModel);
  if (!model->is_object() && older.is_object()) {
    model = &older;
    factor = "diffuseFactor";
  }
  const Json& color = at(*model, factor);
  for (std::size_t k = 0; k < 4; ++k) {
    material.base_color[k] = static_cast<float>(as_number(at(color, k), 1));
  }
  if (shows_emission(entry)) {
    for (std::size_t k = 0; k < 3; ++k) {
      material.base_color[k] = static_cast<float>(
          std::clamp(as_number(at(at(entry, "emissiveFactor"), k), 0), 0.0, 1.0));
    }
  }
  material.double_sided = as_bool(at(entry, "doubleSided"));
  const std::string alpha_mode = as_text(at(entry, "alphaMode"));
  if (alpha_mode == "MASK") {
    material.alpha_cutoff = cutoff_of_texture(at(entry, "alphaCutoff"), material.base_color[3]);
  }
  // 3.9.4: else alpha says nothing, or where there are holes.
  if (alpha_mode != "BLEND") material.base_color[3] = 1;
  // Less than 1 says by itself that it blends.
  material.is_blended = alpha_mode == "BLEND" && material.base_color[3] >= 1;
  material.base_color_texture = images.take(base_color_texture(entry));
  if (material.base_color_texture.empty()) {  // where write_glb() puts it
    material.base_color_texture = as_text(at(at(entry, "extras"), "base_color_texture"));
  }
  return material;
}

}  // namespace

GltfMaterials read_gltf_materials(const Json& json, GltfImages& images) {
  GltfMaterials result;
  Losses losses;
  const Json& entries = at(json, "materials");
  for (std::size_t i = 0; i < size_of(entries); ++i) {
    result.materials.push_back(read_material(entries[i], i, images));
    count_losses(json, entries[i], losses);
    if (shows_emission(entries[i])) losses.add_shown_emission();
  }
  result.notes = losses.notes();
  return result;
}

}  // namespace crease
