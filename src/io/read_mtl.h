// Material libraries of OBJ.
#pragma once

#include "crease/mesh.h"

#include <span>
#include <string>
#include <string_view>

namespace crease {

// Fills in the base colour (Kd, d or Tr) and texture (map_Kd) of the materials that `text` names;
// others stay as they are. `folder`: where the library lies, relative to the OBJ; a texture's path
// gets it in front. Lines that make no sense are passed over: nothing depends on them.
void read_mtl(std::string_view text, const std::string& folder, std::span<Material> materials);

}  // namespace crease
