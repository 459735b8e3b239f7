#include "io/gltf_compression.h"
#include "io/meshopt_attributes.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>

namespace crease {

namespace {

// Of bytes: what few take where all elements are equal, and what others are held to.
constexpr std::size_t kUnpackedAlways = std::size_t(1) << 29, kMaxUnpackedTimes = 64;

enum class MeshoptMode { Attributes, Triangles, Indices, Unknown };

MeshoptMode mode_of(const std::string& name) {
  if (name == "ATTRIBUTES") return MeshoptMode::Attributes;
  if (name == "TRIANGLES") return MeshoptMode::Triangles;
  if (name == "INDICES") return MeshoptMode::Indices;
  return MeshoptMode::Unknown;
}

// What the extension asks of strides and counts, which the library takes for granted.
bool fits(MeshoptMode mode, const std::string& filter, std::size_t stride, std::size_t count) {
  if (mode == MeshoptMode::Attributes) {
    if (stride == 0 || stride > 256 || stride % 4 != 0) return false;
    if (filter == "OCTAHEDRAL" || filter == "COLOR") return stride == 4 || stride == 8;
    if (filter == "QUATERNION") return stride == 8;
    return filter.empty() || filter == "NONE" || filter == "EXPONENTIAL";
  }
  if (mode == MeshoptMode::Triangles && count % 3 != 0) return false;
  return (stride == 2 || stride == 4) && (filter.empty() || filter == "NONE");
}

bool is_version_1(std::span<const std::byte> encoded) {
  return !encoded.empty() && encoded[0] == std::byte{0xa1};
}

// The least that `count` elements take: a sixteenth of 2 bits a byte, in version 1 of attributes
// 2 bits for each byte of a block of 256, or a byte a triangle or index.
std::size_t least_bytes(MeshoptMode mode, std::size_t stride, std::size_t count,
                        std::span<const std::byte> encoded) {
  if (mode == MeshoptMode::Attributes) {
    return is_version_1(encoded) ? count / 256 * (stride / 4) : count / 64 * stride;
  }
  return mode == MeshoptMode::Triangles ? count / 3 : count;
}

int decode_attributes(std::byte* to, std::size_t count, std::size_t stride,
                      std::span<const std::byte> encoded) {
  if (!is_version_1(encoded)) {
    const auto* const from = reinterpret_cast<const unsigned char*>(encoded.data());
    return meshopt_decodeVertexBuffer(to, count, stride, from, encoded.size());
  }
  const auto elements = decode_meshopt_attributes(encoded, count, stride);
  if (!elements) return -1;
  std::memcpy(to, elements->data(), elements->size());
  return 0;
}

int decode(MeshoptMode mode, std::byte* to, std::size_t count, std::size_t stride,
           std::span<const std::byte> encoded) {
  const auto* const from = reinterpret_cast<const unsigned char*>(encoded.data());
  switch (mode) {
    case MeshoptMode::Attributes:
      return decode_attributes(to, count, stride, encoded);
    case MeshoptMode::Triangles:
      return meshopt_decodeIndexBuffer(to, count, stride, from, encoded.size());
    default:
      return meshopt_decodeIndexSequence(to, count, stride, from, encoded.size());
  }
}

}  // namespace

const Json& meshopt_of(const Json& buffer_view) {
  const Json& extensions = at(buffer_view, "extensions");
  const Json& ratified = at(extensions, "KHR_meshopt_compression");
  return ratified.is_object() ? ratified : at(extensions, "EXT_meshopt_compression");
}

Result<std::vector<std::byte>> decode_meshopt(const Source& source, const std::string& place,
                                              const Json& extension,
                                              std::span<const std::byte> encoded) {
  const MeshoptMode mode = mode_of(as_text(at(extension, "mode")));
  const std::string filter = as_text(at(extension, "filter"));
  const std::size_t count = as_index(at(extension, "count")).value_or(0);
  const std::size_t stride = as_index(at(extension, "byteStride")).value_or(0);
  if (mode == MeshoptMode::Unknown || !fits(mode, filter, stride, count)) {
    return fail_at_place(Error::BadFormat, source, place,
                         "mode, filter, byteStride or count wrong");
  }
  const bool is_too_many =
      count > (std::size_t(1) << 32) ||
      count * stride > std::max(kUnpackedAlways, kMaxUnpackedTimes * encoded.size());
  if (is_too_many || least_bytes(mode, stride, count, encoded) > encoded.size()) {
    return fail_at_place(
        Error::BadValue, source, place,
        std::to_string(count) + " elements in " + std::to_string(encoded.size()) + " bytes");
  }
  std::vector<std::byte> bytes((count + 3) / 4 * 4 * stride);  // filters work on four at a time
  if (count > 0 && decode(mode, bytes.data(), count, stride, encoded) != 0) {
    return fail_at_place(Error::BadFormat, source, place, "not what meshoptimizer encodes");
  }
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), (count + 3) / 4 * 4, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), (count + 3) / 4 * 4, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), (count + 3) / 4 * 4, stride);
  bytes.resize(count * stride);
  if (filter == "COLOR") decode_meshopt_colors(bytes, stride);
  return bytes;
}

}  // namespace crease
