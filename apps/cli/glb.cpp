#include "cli/glb.h"

#include "cli/command.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

namespace crease::cli {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
  }
  return value;
}

void put_u32(std::vector<std::byte>& bytes, std::size_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes.push_back(std::byte((value >> (8 * i)) & 0xff));
}

void put_chunk(std::vector<std::byte>& out, std::uint32_t kind, std::span<const std::byte> data,
               std::byte padding) {
  const std::size_t padded = (data.size() + 3) / 4 * 4;
  put_u32(out, padded);
  put_u32(out, kind);
  out.insert(out.end(), data.begin(), data.end());
  out.insert(out.end(), padded - data.size(), padding);
}

struct Glb {
  Json json;
  std::span<const std::byte> binary;
};

// Reads what export_bytes() wrote; anything else is a broken promise of the library.
Result<Glb> split_glb(std::span<const std::byte> bytes) {
  const auto broken = [] { return fail(Error::BadFormat, "a level is no GLB with two chunks"); };
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes || u32_at(bytes, 0) != kGlbMagic) {
    return broken();
  }
  Glb glb;
  std::size_t at = kHeaderBytes;
  while (at + kChunkHeaderBytes <= bytes.size()) {
    const std::size_t size = u32_at(bytes, at);
    const std::uint32_t kind = u32_at(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (size > bytes.size() - at) return broken();
    const std::span<const std::byte> data = bytes.subspan(at, size);
    if (kind == kJsonChunk) {
      const char* text = reinterpret_cast<const char*>(data.data());
      glb.json = Json::parse(text, text + size, nullptr, false);
    } else if (kind == kBinaryChunk) {
      glb.binary = data;
    }
    at += size;
  }
  if (!glb.json.is_object()) return broken();
  return glb;
}

void add_to(Json& object, const char* key, std::size_t offset) {
  if (const auto found = object.find(key); found != object.end()) {
    *found = found->get<std::size_t>() + offset;
  }
}

// Appends array `key` of `from` to that of `to` and returns where it starts there.
std::size_t append(Json& to, const Json& from, const char* key) {
  Json& array = to[key];
  if (array.is_null()) array = Json::array();
  const std::size_t first = array.size();
  if (const auto found = from.find(key); found != from.end()) {
    for (const Json& item : *found) array.push_back(item);
  }
  return first;
}

// Appends a level's buffer views, accessors, materials, meshes and nodes with their indices moved,
// and returns its root nodes.
std::vector<std::size_t> append_level(Json& to, const Json& from, std::size_t binary_offset) {
  const std::size_t view = append(to, from, "bufferViews");
  const std::size_t accessor = append(to, from, "accessors");
  const std::size_t sampler = append(to, from, "samplers");
  const std::size_t image = append(to, from, "images");
  const std::size_t texture = append(to, from, "textures");
  const std::size_t material = append(to, from, "materials");
  const std::size_t mesh = append(to, from, "meshes");
  const std::size_t node = append(to, from, "nodes");
  for (std::size_t i = view; i < to["bufferViews"].size(); ++i) {
    Json& v = to["bufferViews"][i];
    v["byteOffset"] = v.value("byteOffset", std::size_t(0)) + binary_offset;
  }
  for (std::size_t i = accessor; i < to["accessors"].size(); ++i) {
    add_to(to["accessors"][i], "bufferView", view);
  }
  for (std::size_t i = image; i < to["images"].size(); ++i) {
    add_to(to["images"][i], "bufferView", view);
  }
  for (std::size_t i = texture; i < to["textures"].size(); ++i) {
    add_to(to["textures"][i], "source", image);
    add_to(to["textures"][i], "sampler", sampler);
  }
  for (std::size_t i = material; i < to["materials"].size(); ++i) {
    Json& m = to["materials"][i];
    if (m.contains("pbrMetallicRoughness") &&
        m["pbrMetallicRoughness"].contains("baseColorTexture")) {
      add_to(m["pbrMetallicRoughness"]["baseColorTexture"], "index", texture);
    }
  }
  for (std::size_t i = mesh; i < to["meshes"].size(); ++i) {
    for (Json& primitive : to["meshes"][i]["primitives"]) {
      for (auto& [name, index] : primitive["attributes"].items()) {
        index = index.get<std::size_t>() + accessor;
      }
      add_to(primitive, "indices", accessor);
      add_to(primitive, "material", material);
    }
  }
  for (std::size_t i = node; i < to["nodes"].size(); ++i) {
    Json& n = to["nodes"][i];
    add_to(n, "mesh", mesh);
    if (!n.contains("children")) continue;
    for (Json& child : n["children"]) child = child.get<std::size_t>() + node;
  }
  std::vector<std::size_t> roots;
  for (const Json& root : from["scenes"][from.value("scene", std::size_t(0))]["nodes"]) {
    roots.push_back(root.get<std::size_t>() + node);
  }
  return roots;
}

}  // namespace

Result<std::vector<std::byte>> merge_lod_glb(std::span<const std::vector<std::byte>> levels) {
  Json merged = {{"asset", {{"version", "2.0"}, {"generator", "crease"}}}};
  std::vector<std::byte> binary;
  std::vector<std::size_t> node_of_level;
  Json coverage = Json::array();
  for (const std::vector<std::byte>& bytes : levels) {
    Result<Glb> level = split_glb(bytes);
    if (!level.ok()) return level.failure();
    const std::vector<std::size_t> roots = append_level(merged, level->json, binary.size());
    if (level->json.contains("extensionsUsed")) {
      merged["extensionsUsed"] = level->json["extensionsUsed"];
    }
    binary.insert(binary.end(), level->binary.begin(), level->binary.end());
    binary.resize((binary.size() + 3) / 4 * 4);
    if (roots.size() == 1) {
      node_of_level.push_back(roots.front());
    } else {
      node_of_level.push_back(merged["nodes"].size());
      merged["nodes"].push_back({{"children", roots}});
    }
    // A level is meant for half the screen height of the one before.
    coverage.push_back(std::pow(0.5, static_cast<double>(node_of_level.size())));
  }
  coverage.back() = 0.0;  // the coarsest is never culled

  if (node_of_level.size() > 1) {
    Json& finest = merged["nodes"][node_of_level.front()];
    finest["extensions"]["MSFT_lod"]["ids"] =
        std::vector<std::size_t>(node_of_level.begin() + 1, node_of_level.end());
    finest["extras"]["MSFT_screencoverage"] = coverage;
    merged["extensionsUsed"].push_back("MSFT_lod");
  }
  merged["scene"] = 0;
  merged["scenes"] = Json::array({{{"nodes", {node_of_level.front()}}}});
  merged["buffers"] = Json::array({{{"byteLength", binary.size()}}});
  for (const char* key : {"samplers", "images", "textures", "materials"}) {
    if (merged[key].empty()) merged.erase(key);  // glTF allows no empty arrays
  }

  const std::string text = merged.dump();
  std::vector<std::byte> out;
  put_u32(out, kGlbMagic);
  put_u32(out, 2);
  put_u32(out, 0);  // the length, below
  put_chunk(out, kJsonChunk, std::as_bytes(std::span<const char>(text)), std::byte(' '));
  put_chunk(out, kBinaryChunk, binary, std::byte(0));
  if (out.size() > UINT32_MAX) {
    return fail(Error::NotSupported, "a GLB of more than 4 GiB; leave out --lod-glb");
  }
  for (std::size_t i = 0; i < 4; ++i) out[8 + i] = std::byte((out.size() >> (8 * i)) & 0xff);
  return out;
}

}  // namespace crease::cli
