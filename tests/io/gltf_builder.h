// glTF files for tests, put together accessor by accessor.
//
//   GltfBuilder b;
//   b.primitive({{"POSITION", b.add<float>({0,0,0, 1,0,0, 0,1,0}, "VEC3")}});
//   import_text(b.gltf(), "triangle.gltf");  import_text(b.glb(), "triangle.glb");
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace crease {

class GltfBuilder {
 public:
  using Json = nlohmann::json;
  using Attributes = std::map<std::string, std::size_t>;

  // The file but its buffer; tests change what they want to be odd.
  Json json = {{"asset", {{"version", "2.0"}}},
               {"accessors", Json::array()},
               {"bufferViews", Json::array()}};

  // Raw bytes as a bufferView of their own.
  template <typename T>
  std::size_t add_view(const std::vector<T>& values, std::size_t stride = 0) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    const std::size_t offset = binary_.size();
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    binary_.append(bytes, values.size() * sizeof(T));
    Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", binary_.size() - offset}};
    if (stride > 0) view["byteStride"] = stride;
    json["bufferViews"].push_back(view);
    return json["bufferViews"].size() - 1;
  }

  // An accessor of a view; the count follows from the number of components.
  std::size_t add_accessor(Json accessor) {
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }

  template <typename T>
  std::size_t add(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    Json accessor = {{"bufferView", add_view(values)},
                     {"componentType", component_type<T>()},
                     {"count", values.size() / components},
                     {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return add_accessor(std::move(accessor));
  }

  // One more primitive of mesh 0. Returns it, to be changed; valid until the next one.
  Json& primitive(const Attributes& attributes) {
    json["meshes"][0]["primitives"].push_back({{"attributes", attributes}});
    return json["meshes"][0]["primitives"].back();
  }
  Json& primitive(const Attributes& attributes, std::size_t indices) {
    Json& result = primitive(attributes);
    result["indices"] = indices;
    return result;
  }

  // With the buffer as a data URI.
  std::string gltf() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", binary_.size()},
                         {"uri", "data:application/octet-stream;base64," + base64(binary_)}}};
    return whole.dump();
  }
  // With the buffer in a file of that name.
  std::string gltf_beside(const std::string& uri) const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", binary_.size()}, {"uri", uri}}};
    return whole.dump();
  }
  const std::string& binary() const { return binary_; }

  std::string glb() const {
    Json whole = json;
    whole["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = whole.dump(), binary = binary_;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    return "glTF" + u32(2) + u32(28 + text.size() + binary.size()) + u32(text.size()) + "JSON" +
           text + u32(binary.size()) + std::string("BIN\0", 4) + binary;
  }
  // 3D Tiles 1.0 around it: JSON and binary part of the feature table, JSON of the batch table.
  std::string b3dm(std::string features = "{\"BATCH_LENGTH\":0}", const std::string& binary = "",
                   std::string batches = "") const {
    const std::string inside = glb();
    features.resize((features.size() + 3) / 4 * 4, ' ');
    batches.resize((batches.size() + 3) / 4 * 4, ' ');
    return "b3dm" + u32(1) +
           u32(28 + features.size() + binary.size() + batches.size() + inside.size()) +
           u32(features.size()) + u32(binary.size()) + u32(batches.size()) + u32(0) + features +
           binary + batches + inside;
  }

 private:
  template <typename T>
  static int component_type() {
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    if (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
  }
  static std::string u32(std::size_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
  }
  static std::string base64(const std::string& bytes) {
    static const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        text += i + k < bytes.size() + 1 ? digits[bits >> (18 - 6 * k) & 63] : '=';
      }
    }
    return text;
  }

  std::string binary_;
};

}  // namespace crease
