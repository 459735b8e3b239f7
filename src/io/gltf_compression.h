// Compressed glTF: buffer views of EXT_meshopt_compression and KHR_meshopt_compression, and
// primitives of KHR_draco_mesh_compression. The files that include the two libraries.
#pragma once

#include "crease/result.h"
#include "io/gltf_document.h"
#include "io/json.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

// The object of either name that a buffer view has, or null.
const Json& meshopt_of(const Json& buffer_view);

// The bytes of a buffer view, out of `encoded`. `extension` is meshopt_of() it. Fails if they are
// not what it says. Takes no more memory than a small multiple of `encoded`, or, of version 1, of
// 1024 times and half a gigabyte the lesser.
Result<std::vector<std::byte>> decode_meshopt(const Source& source, const std::string& place,
                                              const Json& extension,
                                              std::span<const std::byte> encoded);

// A primitive's triangles and, for each id of `ids`, the values of its vertices.
struct DracoPrimitive {
  std::vector<std::uint32_t> indices;
  std::size_t vertex_count = 0;
  std::vector<GltfReader::Floats> attributes;  // as `ids`; numbers as they are stored
};
// Fails if they are no such mesh, or it has more than `most` vertices or triangles.
Result<DracoPrimitive> decode_draco(const Source& source, const std::string& place,
                                    std::span<const std::byte> encoded,
                                    std::span<const std::uint32_t> ids, std::size_t most);

}  // namespace crease
