#include "io/gltf_compression.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace crease {

namespace {

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
    if (filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
    if (filter == "QUATERNION") return stride == 8;
    return filter.empty() || filter == "NONE" || filter == "EXPONENTIAL";
  }
  if (mode == MeshoptMode::Triangles && count % 3 != 0) return false;
  return (stride == 2 || stride == 4) && (filter.empty() || filter == "NONE");
}

// The least that `count` elements take: a sixteenth of 2 bits a byte, or a byte a triangle or
// index.
std::size_t least_bytes(MeshoptMode mode, std::size_t stride, std::size_t count) {
  if (mode == MeshoptMode::Attributes) return count / 64 * stride;
  return mode == MeshoptMode::Triangles ? count / 3 : count;
}

int decode(MeshoptMode mode, std::byte* to, std::size_t count, std::size_t stride,
           std::span<const std::byte> encoded) {
  const auto* const from = reinterpret_cast<const unsigned char*>(encoded.data());
  switch (mode) {
    case MeshoptMode::Attributes:
      return meshopt_decodeVertexBuffer(to, count, stride, from, encoded.size());
    case MeshoptMode::Triangles:
      return meshopt_decodeIndexBuffer(to, count, stride, from, encoded.size());
    default:
      return meshopt_decodeIndexSequence(to, count, stride, from, encoded.size());
  }
}

}  // namespace

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
  if (count > (std::size_t(1) << 32) || least_bytes(mode, stride, count) > encoded.size()) {
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
  return bytes;
}

}  // namespace crease
