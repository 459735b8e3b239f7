// Which texture coordinates a model's textures go by.
#pragma once

#include "crease/ids.h"
#include "crease/mesh.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace crease {

// The first layer of texture coordinates in a plane; kNone where no material has a texture.
// `Layer`: of any kind of arrays that has a role and a dimension.
template <typename Layer>
std::uint32_t painted_layer(const std::vector<Layer>& layers,
                            const std::vector<Material>& materials) {
  const bool has_texture = std::any_of(materials.begin(), materials.end(), [](const Material& m) {
    return !m.base_color_texture.empty();
  });
  for (std::uint32_t l = 0; has_texture && l < layers.size(); ++l) {
    if (layers[l].role == AttributeRole::TexCoord && layers[l].dimension == 2) return l;
  }
  return kNone;
}

}  // namespace crease
