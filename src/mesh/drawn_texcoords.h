// Which texture coordinates are for drawing.
#pragma once

#include "crease/ids.h"
#include "crease/mesh.h"

#include <cstdint>
#include <vector>

namespace crease {

// The first layer of texture coordinates in a plane, or kNone. Whether a material has a texture
// does not matter: an engine may have its own. `Layer`: of any kind of arrays that has a role and a
// dimension.
template <typename Layer>
std::uint32_t drawn_texcoords(const std::vector<Layer>& layers) {
  for (std::uint32_t l = 0; l < layers.size(); ++l) {
    if (layers[l].role == AttributeRole::TexCoord && layers[l].dimension == 2) return l;
  }
  return kNone;
}

}  // namespace crease
