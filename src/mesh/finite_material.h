#pragma once

#include "crease/mesh.h"

#include <cmath>

namespace crease {

// Whether all numbers of the material are.
inline bool is_finite(const Material& material) {
  const auto& [red, green, blue, alpha] = material.base_color;
  return std::isfinite(red + green + blue + alpha) && std::isfinite(material.alpha_cutoff);
}

}  // namespace crease
