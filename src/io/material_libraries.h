// The material libraries that an OBJ names, and what they say of its materials.
//
//   const MaterialLibraries libraries = read_material_libraries(folder, named, raw.materials);
#pragma once

#include "crease/mesh.h"
#include "io/read_mtl.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace crease {

struct MaterialLibraries {
  std::vector<TexturePlacement> placement_of_material;
  std::vector<std::string> notes;  // libraries that were not found, materials that none has
  std::vector<std::filesystem::path> files;  // that were read
};

// Fills in `materials`. `named`: what follows each `mtllib`: one name, with blanks in it or not, or
// several. Files are found like images, in `folder` and below it, by their last part if need be.
MaterialLibraries read_material_libraries(const std::filesystem::path& folder,
                                          std::span<const std::string> named,
                                          std::span<Material> materials);

}  // namespace crease
