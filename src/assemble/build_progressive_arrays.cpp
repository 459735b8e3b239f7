#include "crease/build_progressive_arrays.h"
#include "assemble/arrange.h"
#include "assemble/restructure.h"

#include <memory>
#include <utility>

namespace crease {

ProgressiveArraysPtr build_progressive_arrays(const Mesh& snapped,
                                              const ContractionSequence& sequence) {
  Restructured parts = restructure(snapped, sequence);
  return std::make_shared<const ProgressiveArrays>(
      arrange(snapped, sequence, std::move(parts), nullptr));
}

}  // namespace crease
