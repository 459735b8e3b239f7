// Material libraries of OBJ.
#pragma once

#include "crease/mesh.h"
#include "io/losses.h"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// How a texture lies on texture coordinates: at u * scale[0] + offset[0], v likewise.
struct TexturePlacement {
  std::array<float, 2> scale{1, 1}, offset{};  // -s and -o
  bool operator==(const TexturePlacement&) const = default;
};

// Fills in the base colour (Kd, d or Tr) and texture (map_Kd) of the materials that `text` names,
// and how it lies; others stay as they are. Tr is 1 - d; where both stand, some exporters write the
// same number for both, and d is what is meant. Tr 1 alone for all that tells any is MeshLab's
// way to say opaque. `folder`: where the library lies, relative to the
// OBJ; a texture's path gets it in front. Lines that make no sense are passed over: nothing depends
// on them. `is_known` becomes true for those that it names; where a name as a whole is not one,
// what follows " #" is a comment. `losses`: textures of other kinds than map_Kd, and emission.
void read_mtl(std::string_view text, const std::string& folder, std::span<Material> materials,
              std::span<TexturePlacement> placement_of_material, std::vector<bool>& is_known,
              Losses& losses);

}  // namespace crease
