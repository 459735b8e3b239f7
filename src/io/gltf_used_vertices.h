// Primitives that share one vertex buffer, of which each uses a small part: city models have a
// thousand of them.
#pragma once

#include "io/gltf_document.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

// Of a primitive whose indices use at most half of its attributes' `vertex_count` vertices, the
// reader gives these alone from here on, and `indices` are those among them. Returns which they
// are, ascending. Else, and where an attribute cannot be read or has another count, nothing is
// changed and it returns none. Time O(vertex_count) an attribute.
std::vector<std::uint32_t> keep_used_vertices(const Json& attributes, std::size_t vertex_count,
                                              std::vector<std::uint32_t>& indices,
                                              GltfReader& reader);

}  // namespace crease
