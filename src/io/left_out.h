// What of a mesh has no place in a format.
#pragma once

#include "crease/mesh.h"

#include <string>
#include <string_view>
#include <vector>

namespace crease {

// The layer that OBJ writes for a role, or null: it has a place for one of each.
const AttributeLayer* first_layer(const Mesh& mesh, AttributeRole role);

// The attribute bytes of facets, as the reader carries them and an STL can have them again; or
// null.
const AttributeLayer* stl_attribute(const Mesh& mesh);

// In words: "normals", "colours 'color'", "parts (12)". `ending`: ".obj", ".ply", ".stl" or ".glb".
std::vector<std::string> left_out(const Mesh& mesh, std::string_view ending);

}  // namespace crease
