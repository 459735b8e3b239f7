// Layers of extracted meshes.
#pragma once

#include "crease/mesh.h"

namespace crease {

// Without values and corners; what the layer means is as in `source`, a layer of any kind of
// arrays.
template <typename Source>
AttributeLayer layer_like(const Source& source) {
  return {.name = source.name,
          .role = source.role,
          .interpolation = source.interpolation,
          .dimension = source.dimension,
          .values = {},
          .of_corner = {}};
}

}  // namespace crease
