// Meshes that have vertices in common -> one mesh.
#pragma once

#include "crease/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

struct NamedMesh {
  Mesh mesh;
  std::vector<std::uint64_t> names;  // per vertex; the same one in two meshes is the same vertex
};

// All of them have the same layers, and a vertex has the same position in all. Attributes of two
// meshes become one where a vertex has them in both with the same value. Materials and parts are
// those of the first one; there must be one. Time near linear.
Mesh join_meshes(std::span<const NamedMesh> meshes);

}  // namespace crease
