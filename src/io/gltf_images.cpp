#include "io/gltf_images.h"

#include "io/images.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace crease {

namespace {

// texture.source, or what an extension has in its place: EXT_texture_webp, KHR_texture_basisu.
std::optional<std::size_t> source_of(const Json& texture) {
  if (const auto source = as_index(at(texture, "source"))) return source;
  const Json& extensions = at(texture, "extensions");
  if (!extensions.is_object()) return std::nullopt;
  for (const auto& [name, extension] : extensions.items()) {
    if (const auto source = as_index(at(extension, "source"))) return source;
  }
  return std::nullopt;
}

}  // namespace

bool shows_emission(const Json& material) {
  const auto most_of = [](const Json& color) {
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, as_number(at(color, k), 0));
    return most;
  };
  const Json& base = at(at(material, "pbrMetallicRoughness"), "baseColorFactor");
  return base.is_array() && most_of(base) == 0 && most_of(at(material, "emissiveFactor")) > 0;
}

const Json& base_color_texture(const Json& material) {
  if (shows_emission(material)) return at(material, "emissiveTexture");
  const Json& model = at(material, "pbrMetallicRoughness");
  const Json& older = at(at(material, "extensions"), "KHR_materials_pbrSpecularGlossiness");
  return !model.is_object() && older.is_object() ? at(older, "diffuseTexture")
                                                 : at(model, "baseColorTexture");
}

TextureUse texture_use(const Json& texture_info) {
  TextureUse use;
  const Json& transform = at(at(texture_info, "extensions"), "KHR_texture_transform");
  const auto set = as_index(at(transform, "texCoord"));
  use.set = set ? *set : as_index(at(texture_info, "texCoord")).value_or(0);
  if (!transform.is_object()) return use;
  // translation * rotation * scale, a positive angle turning u towards -v.
  const double angle = as_number(at(transform, "rotation"), 0);
  const double c = std::cos(angle), s = std::sin(angle);
  const double width = as_number(at(at(transform, "scale"), std::size_t(0)), 1);
  const double height = as_number(at(at(transform, "scale"), std::size_t(1)), 1);
  use.matrix = {static_cast<float>(c * width), static_cast<float>(s * height),
                static_cast<float>(-s * width), static_cast<float>(c * height)};
  for (std::size_t k = 0; k < 2; ++k) {
    use.offset[k] = static_cast<float>(as_number(at(at(transform, "offset"), k), 0));
  }
  return use;
}

std::string GltfImages::take(const Json& texture_info) {
  const auto texture = as_index(at(texture_info, "index"));
  if (!texture) return {};
  const auto image = source_of(at(at(json_, "textures"), *texture));
  if (!image) {
    if (without_image_.insert(*texture).second) {
      notes.push_back("texture left out: " + source_.name + ": " + place_of("textures", *texture) +
                      ": has no image");
    }
    return {};
  }
  const auto [known, is_new] = name_of_image_.try_emplace(*image);
  if (is_new) known->second = take_image(*image);
  return known->second;
}

// Of the images that lie beside the glTF.
bool GltfImages::is_file(const std::string& name) const {
  const Json& entries = at(json_, "images");
  for (std::size_t i = 0; i < size_of(entries); ++i) {
    const std::string uri = as_text(at(entries[i], "uri"));
    if (!uri.empty() && !uri.starts_with("data:") && percent_decoded(uri) == name) return true;
  }
  return false;
}

std::string GltfImages::take_image(std::size_t index) {
  const std::string place = place_of("images", index);
  const Json& image = at(at(json_, "images"), index);
  const std::string uri = as_text(at(image, "uri"));
  if (!uri.empty() && !uri.starts_with("data:")) return percent_decoded(uri);
  std::string name = as_text(at(image, "name"));
  name = unused_name(images, name.empty() ? place : name);
  while (is_file(name)) name = unused_name(images, name + " inside");
  Result<std::vector<std::byte>> bytes = bytes_of(image, place);
  if (bytes.ok() && image_type(*bytes).empty()) {
    bytes = fail_at_place(Error::NotSupported, source_, place, why_no_image(*bytes));
  }
  if (!bytes.ok()) {
    notes.push_back("texture left out: " + bytes.failure().message);
    return {};
  }
  taken_bytes_ += bytes->size();
  images.push_back({name, std::make_shared<const std::vector<std::byte>>(*std::move(bytes))});
  return name;
}

Result<std::vector<std::byte>> GltfImages::bytes_of(const Json& image, const std::string& place) {
  if (images.size() >= kMaxImages) {
    return fail_at_place(Error::OverLimit, source_, place,
                         "more than " + std::to_string(kMaxImages) + " images");
  }
  const std::string* uri = at(image, "uri").get_ptr<const std::string*>();
  if (uri != nullptr) return decode_data_uri(source_, place + ".uri", *uri);
  const auto bytes = reader_.view_bytes(at(image, "bufferView"), place + ".bufferView");
  if (!bytes.ok()) return bytes.failure();
  // Views may overlap, so a small file could ask for any amount of memory.
  if (bytes->size() > kMaxImageBytes || taken_bytes_ + bytes->size() > reader_.buffer_bytes()) {
    return fail_at_place(Error::OverLimit, source_, place, "images larger than their buffers");
  }
  return std::vector<std::byte>(bytes->begin(), bytes->end());
}

}  // namespace crease
