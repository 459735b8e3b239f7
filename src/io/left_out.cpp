#include "io/left_out.h"

#include "io/formats.h"
#include "io/glb_streams.h"
#include "io/split_vertices.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

namespace crease {

namespace {

std::string in_words(const AttributeLayer& layer) {
  const std::string name = "'" + layer.name + "'";
  switch (layer.role) {
    case AttributeRole::Normal:
      return "normals";
    case AttributeRole::TexCoord:
      return "texture coordinates " + name;
    case AttributeRole::Color:
      return "colours " + name;
    case AttributeRole::Other:
      return name;
  }
  return name;
}

std::string counted(const char* what, std::size_t count) {
  return std::string(what) + " (" + std::to_string(count) + ")";
}

// What alpha means, and which sides are seen: where other formats say so, they say it in too many
// ways to be understood.
void add_hints(const Mesh& mesh, std::vector<std::string>& words) {
  const auto count = std::ranges::count_if(mesh.materials, [](const Material& material) {
    return material.alpha_cutoff > 0 && !material.base_color_texture.empty();
  });
  if (count > 0) {
    words.push_back(
        counted("holes of materials by their textures' alpha", static_cast<std::size_t>(count)));
  }
  const auto blended = std::ranges::count_if(mesh.materials, &Material::is_blended);
  if (blended > 0) {
    words.push_back(counted("blending of materials", static_cast<std::size_t>(blended)));
  }
  const auto double_sided = std::ranges::count_if(mesh.materials, &Material::double_sided);
  if (double_sided > 0) {
    words.push_back(counted("both sides of materials", static_cast<std::size_t>(double_sided)));
  }
}

// A texture whose image the mesh does not have is a name and no picture.
void add_images(const Mesh& mesh, std::vector<std::string>& words) {
  std::set<std::string> missing;
  for (const Material& material : mesh.materials) {
    const std::string& name = material.base_color_texture;
    if (!name.empty() && find_image(mesh.images, name) == nullptr) missing.insert(name);
  }
  if (!missing.empty()) words.push_back(counted("images that textures name", missing.size()));
}

bool has_alpha(const AttributeLayer& colors) {
  if (colors.dimension < 4) return false;
  for (std::size_t i = 3; i < colors.values.size(); i += colors.dimension) {
    if (colors.values[i] != 1) return true;
  }
  return false;
}

std::vector<std::string> left_out_of_obj(const Mesh& mesh) {
  std::vector<std::string> words;
  for (const AttributeLayer& layer : mesh.layers) {
    const bool has_place =
        layer.role != AttributeRole::Other && first_layer(mesh, layer.role) == &layer;
    if (!has_place) {
      words.push_back(in_words(layer));
    } else if (layer.role == AttributeRole::Color && has_alpha(layer)) {
      words.push_back("alpha of " + in_words(layer));
    }
  }
  add_hints(mesh, words);
  add_images(mesh, words);
  return words;
}

std::vector<std::string> left_out_of_glb(const Mesh& mesh) {
  std::vector<std::string> words;
  for (const AttributeLayer& layer : mesh.layers) {
    if (has_large_categories(layer)) {
      words.push_back("that " + in_words(layer) + " are categories and no plain numbers");
    }
  }
  add_images(mesh, words);
  return words;
}

std::vector<std::string> left_out_of_ply(const Mesh& mesh) {
  std::vector<std::string> words;
  add_hints(mesh, words);
  add_images(mesh, words);
  return words;
}

std::vector<std::string> left_out_of_stl(const Mesh& mesh) {
  std::vector<std::string> words;
  for (const AttributeLayer& layer : mesh.layers) {
    if (&layer != stl_attribute(mesh)) words.push_back(in_words(layer));
  }
  if (!mesh.material_of_triangle.empty()) {
    words.push_back(counted("materials", mesh.materials.size()));
  }
  if (!mesh.part_of_triangle.empty()) words.push_back(counted("parts", mesh.parts.size()));
  return words;
}

}  // namespace

const AttributeLayer* first_layer(const Mesh& mesh, AttributeRole role) {
  const auto found = std::ranges::find(mesh.layers, role, &AttributeLayer::role);
  return found == mesh.layers.end() ? nullptr : &*found;
}

const AttributeLayer* stl_attribute(const Mesh& mesh) {
  const auto found = std::ranges::find(mesh.layers, kStlAttribute, &AttributeLayer::name);
  if (found == mesh.layers.end() || found->dimension != 1 || !is_per_triangle(*found)) {
    return nullptr;
  }
  const bool fits = std::ranges::all_of(
      found->values, [](float x) { return x >= 0 && x <= 0xffff && std::floor(x) == x; });
  return fits ? &*found : nullptr;
}

std::vector<std::string> left_out(const Mesh& mesh, std::string_view ending) {
  if (ending == ".obj") return left_out_of_obj(mesh);
  if (ending == ".ply") return left_out_of_ply(mesh);
  if (ending == ".stl") return left_out_of_stl(mesh);
  if (ending == ".glb") return left_out_of_glb(mesh);
  return {};
}

}  // namespace crease
