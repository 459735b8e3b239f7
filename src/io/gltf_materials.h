// The materials of a glTF: base colours and their textures. What else they say is counted.
#pragma once

#include "crease/mesh.h"
#include "io/gltf_images.h"
#include "io/json.h"

#include <string>
#include <vector>

namespace crease {

struct GltfMaterials {
  std::vector<Material> materials;  // as many as the glTF has
  // One for each kind of thing that is not kept: "2 materials lose emission".
  std::vector<std::string> notes;
};

// `images` takes the textures of base colours that are inside the file.
GltfMaterials read_gltf_materials(const Json& json, GltfImages& images);

}  // namespace crease
