// What stands where a layer has no value: of primitives beside each other, and of files.
#pragma once

#include "crease/mesh.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease {

// White and opaque, or zero.
inline float fill_of(AttributeRole role) {
  return role == AttributeRole::Color ? 1.0f : 0.0f;
}

// More numbers a value, those that are new of the fill. Of an AttributeLayer or a RawLayer.
template <typename Layer>
void widen(Layer& layer, std::uint32_t dimension) {
  const std::size_t count = layer.value_count();
  std::vector<float> values(count * dimension, fill_of(layer.role));
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(&layer.values[i * layer.dimension], layer.dimension, &values[i * dimension]);
  }
  layer.values = std::move(values);
  layer.dimension = dimension;
}

}  // namespace crease
