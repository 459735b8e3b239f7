// The values of a layer under a contraction sequence: the input's, then the sequence's own.
#pragma once

#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstddef>
#include <span>

namespace crease {

inline std::size_t new_value_count(const AttributeLayer& source,
                                   const ContractionSequence& sequence, std::size_t layer) {
  if (layer >= sequence.new_values.size() || source.dimension == 0) return 0;
  return sequence.new_values[layer].size() / source.dimension;
}

inline std::span<const float> attribute_value(const AttributeLayer& source,
                                              const ContractionSequence& sequence,
                                              std::size_t layer, AttributeId id) {
  const std::size_t input_count = source.value_count();
  if (index_of(id) < input_count) return source.value(id);
  return std::span<const float>(sequence.new_values[layer])
      .subspan((index_of(id) - input_count) * source.dimension, source.dimension);
}

}  // namespace crease
