// GLB and b3dm containers, "data:" URIs and files beside a .gltf.
#include "base/bytes.h"
#include "io/gltf_document.h"
#include "io/read_beside.h"
#include "io/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace crease {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kB3dmMagic = 0x6D643362;  // "b3dm"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"

std::string_view characters(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// `glb` is the part of the source's bytes that holds the GLB.
Result<GltfDocument> open_glb(const Source& source, std::span<const std::byte> glb) {
  const std::size_t base = static_cast<std::size_t>(glb.data() - source.bytes.data());
  if (glb.size() < 20) {
    return fail_at_byte(Error::Truncated, source, base + glb.size(), "GLB ends inside its header");
  }
  const std::uint32_t version = u32_at(glb, 4);
  if (version != 2) {
    return fail_at_byte(Error::NotSupported, source, base + 4,
                        "GLB version " + std::to_string(version) + "; only 2 is read");
  }
  const std::size_t length = u32_at(glb, 8);
  if (length > glb.size()) {
    return fail_at_byte(Error::Truncated, source, base + 8,
                        "header says " + std::to_string(length) + " bytes, there are " +
                            std::to_string(glb.size()));
  }
  if (length < 20) return fail_at_byte(Error::BadFormat, source, base + 8, "impossible length");
  GltfDocument document;
  bool has_json = false;
  for (std::size_t offset = 12; offset < length;) {
    if (length - offset < 8) {
      return fail_at_byte(Error::Truncated, source, base + offset, "chunk header cut off");
    }
    const std::size_t chunk_length = u32_at(glb, offset);
    const std::uint32_t type = u32_at(glb, offset + 4);
    if (chunk_length > length - offset - 8) {
      return fail_at_byte(Error::Truncated, source, base + offset,
                          "chunk of " + std::to_string(chunk_length) + " bytes, " +
                              std::to_string(length - offset - 8) + " are left");
    }
    const auto chunk = glb.subspan(offset + 8, chunk_length);
    if (!has_json) {
      if (type != kJsonChunk) {
        return fail_at_byte(Error::BadFormat, source, base + offset, "the first chunk is not JSON");
      }
      Result<Json> json = parse_json(source, characters(chunk), base + offset + 8);
      if (!json.ok()) return json.failure();
      document.json = *std::move(json);
      has_json = true;
    } else if (type == kBinChunk && document.binary_chunk.empty()) {
      document.binary_chunk = chunk;
    }
    offset += 8 + chunk_length;
  }
  document.format = "GLB";
  return document;
}

// RTC_CENTER of a feature table: three numbers, or where three floats are in its binary part, which
// the bytes from `begin` to `end` are.
Result<Vec3d> tile_center(const Source& source, const Json& stored, std::size_t begin,
                          std::size_t end) {
  if (stored.is_null()) return Vec3d{};
  if (const auto center = as_vector(stored)) return *center;
  constexpr std::size_t kBytes = 12;
  const auto offset = as_index(at(stored, "byteOffset"));
  if (!offset) {
    return fail_at_place(Error::BadFormat, source, "RTC_CENTER",
                         "neither three numbers nor where they are");
  }
  if (end - begin < kBytes || *offset > end - begin - kBytes) {
    return fail_at_place(Error::BadValue, source, "RTC_CENTER.byteOffset",
                         std::to_string(*offset) + " of " + std::to_string(end - begin) +
                             " bytes does not leave three floats");
  }
  Vec3d center;
  for (int k = 0; k < 3; ++k) {
    const std::size_t at = begin + *offset + 4 * static_cast<std::size_t>(k);
    center[k] = static_cast<double>(std::bit_cast<float>(u32_at(source.bytes, at)));
  }
  return center;
}

// Centres are z-up, as tiles and the globe are, the glTF is y-up, and positions stay so.
Vec3d turned_to_y_up(const Vec3d& center) {
  return {center.x, center.z, -center.y};
}

// What a batch table loses, whose JSON this is.
void tell_batch_table(const Source& source, std::span<const std::byte> json,
                      std::vector<std::string>& notes) {
  if (json.empty()) return;
  const Result<Json> table = parse_json(source, characters(json), 0);
  if (!table.ok() || !table->is_object()) {
    notes.push_back("a batch table that is no JSON object ignored");
  } else if (!table->empty()) {
    notes.push_back(std::to_string(table->size()) +
                    " properties of the batch table ignored: batch ids are kept, what they stand "
                    "for is not");
  }
}

// 3D Tiles 1.0, Batched 3D Model: a header of 28 bytes and four tables before a GLB.
Result<GltfDocument> open_b3dm(const Source& source) {
  constexpr std::size_t kHeader = 28;
  const auto bytes = source.bytes;
  if (bytes.size() < kHeader) {
    return fail_at_byte(Error::Truncated, source, bytes.size(), "b3dm ends inside its header");
  }
  std::size_t glb_offset = kHeader;
  for (std::size_t field = 12; field < kHeader; field += 4) glb_offset += u32_at(bytes, field);
  if (glb_offset > bytes.size()) {
    return fail_at_byte(Error::Truncated, source, 12,
                        "b3dm tables reach to byte " + std::to_string(glb_offset) +
                            ", the file ends at " + std::to_string(bytes.size()));
  }
  const auto glb = bytes.subspan(glb_offset);
  if (glb.size() < 4 || u32_at(glb, 0) != kGlbMagic) {
    return fail_at_byte(Error::BadFormat, source, glb_offset, "no GLB where b3dm should have one");
  }
  Result<GltfDocument> document = open_glb(source, glb);
  if (!document.ok()) return document;
  document->format = "b3dm";
  const std::size_t features_length = u32_at(bytes, 12), binary_length = u32_at(bytes, 16);
  tell_batch_table(source,
                   bytes.subspan(kHeader + features_length + binary_length, u32_at(bytes, 20)),
                   document->notes);
  if (features_length > 0) {
    Result<Json> table =
        parse_json(source, characters(bytes.subspan(kHeader, features_length)), kHeader);
    if (!table.ok()) return table.failure();
    const std::size_t begin = kHeader + features_length;
    const Result<Vec3d> center =
        tile_center(source, at(*table, "RTC_CENTER"), begin, begin + binary_length);
    if (!center.ok()) return center.failure();
    document->center = turned_to_y_up(*center);
  }
  return document;
}

// Extensions that a file may require although nothing here depends on them: materials (techniques
// are glTF 1.0's), textures and lights change no triangle. KHR_mesh_quantization, CESIUM_RTC, the
// two compressions, instances and what is visible are read.
bool is_harmless(const std::string& extension) {
  static constexpr std::array kPrefixes = {"KHR_materials_",
                                           "KHR_texture_",
                                           "EXT_texture_",
                                           "MSFT_texture_",
                                           "KHR_lights_",
                                           "KHR_techniques_webgl",
                                           "KHR_xmp",
                                           "KHR_mesh_quantization",
                                           "CESIUM_RTC",
                                           "MSFT_lod",
                                           "EXT_mesh_features",
                                           "EXT_mesh_gpu_instancing",
                                           "KHR_node_visibility",
                                           "EXT_structural_metadata",
                                           "EXT_meshopt_compression",
                                           "KHR_meshopt_compression",
                                           "KHR_draco_mesh_compression"};
  return std::ranges::any_of(kPrefixes, [&](const char* p) { return extension.starts_with(p); });
}

}  // namespace

Status check_required_extensions(const Source& source, const Json& json) {
  const Json& required = at(json, "extensionsRequired");
  for (std::size_t i = 0; i < size_of(required); ++i) {
    const std::string extension = as_text(required[i]);
    if (is_harmless(extension)) continue;
    const bool compressed = extension.find("compression") != std::string::npos;
    return fail_at_place(
        Error::NotSupported, source, place_of("extensionsRequired", i),
        in_quotes(extension) + " is not supported" +
            (compressed ? "; KHR_meshopt_compression and KHR_draco_mesh_compression are" : ""));
  }
  return Done{};
}

Result<GltfDocument> open_gltf(const Source& source) {
  Result<GltfDocument> document = GltfDocument{};
  const auto bytes = source.bytes;
  const std::uint32_t magic = bytes.size() >= 4 ? u32_at(bytes, 0) : 0;
  if (magic == kGlbMagic) {
    document = open_glb(source, bytes);
  } else if (magic == kB3dmMagic) {
    document = open_b3dm(source);
  } else {
    const std::string_view text = source.text();
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    if (first == text.npos || text[first] != '{') {
      return fail_at_byte(Error::BadFormat, source, 0, "neither GLB nor b3dm nor a JSON object");
    }
    Result<Json> json = parse_json(source, text, 0);
    if (!json.ok()) return json.failure();
    document->json = *std::move(json);
    document->format = "glTF";
  }
  if (!document.ok()) return document;
  const Json& json = document->json;
  if (!json.is_object()) return fail_at_byte(Error::BadFormat, source, 0, "JSON is not an object");
  const std::string version = as_text(at(at(json, "asset"), "version"));
  if (!version.empty() && !version.starts_with("2.")) {
    return fail_at_place(Error::NotSupported, source, "asset.version",
                         "glTF " + in_quotes(version) + "; only 2.0 is read");
  }
  const std::string least = as_text(at(at(json, "asset"), "minVersion"));
  if (!least.empty() && least != "2.0" && !least.starts_with("1.")) {
    return fail_at_place(Error::NotSupported, source, "asset.minVersion",
                         "needs glTF " + in_quotes(least) + "; only 2.0 is read");
  }
  if (at(json, "meshes").is_object()) {  // glTF 1.0 had names where 2.0 has indices
    return fail_at_place(Error::NotSupported, source, "meshes",
                         "an object, as in glTF 1.0; only 2.0 is read");
  }
  if (const auto center = as_vector(at(at(at(json, "extensions"), "CESIUM_RTC"), "center"))) {
    document->center += turned_to_y_up(*center);
  }
  return document;
}

Result<std::vector<std::byte>> decode_data_uri(const Source& source, const std::string& place,
                                               std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
    return fail_at_place(Error::NotSupported, source, place, "data URI that is not base64");
  }
  std::string_view text = uri.substr(comma + 1);
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (const char c : text) {
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z')
      value = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      value = static_cast<std::uint32_t>(c - 'a' + 26);
    else if (c >= '0' && c <= '9')
      value = static_cast<std::uint32_t>(c - '0' + 52);
    else if (c == '+' || c == '-')
      value = 62;
    else if (c == '/' || c == '_')
      value = 63;
    else
      return fail_at_place(Error::BadFormat, source, place, "data URI with a bad character");
    bits = bits << 6 | value;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xff));
  }
  return bytes;
}

// "%20" and the like. A bad escape stays as it is.
std::string percent_decoded(std::string_view uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
  };
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      result += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

Result<std::vector<std::byte>> read_beside(const Source& source, const std::string& place,
                                           std::string_view uri) {
  if (source.folder == nullptr) {
    return fail_at_place(Error::NotFound, source, place,
                         "refers to " + in_quotes(uri) + ", and there is no folder to look in");
  }
  Result<std::vector<std::byte>> bytes =
      read_in_folder(*source.folder, percent_decoded(uri), std::numeric_limits<std::size_t>::max());
  if (bytes.ok()) return bytes;
  return fail_at_place(bytes.failure().error, source, place, bytes.failure().message);
}

}  // namespace crease
