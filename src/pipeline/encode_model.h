// Mesh + ContractionSequence -> model.crease.
#pragma once

#include "codec/byte_sink.h"
#include "codec/layer_coding.h"
#include "crease/contraction.h"
#include "crease/mesh.h"
#include "crease/progress.h"
#include "crease/result.h"

#include <cstdint>
#include <span>

namespace crease {

struct EncodedModel {
  std::uint32_t blocks = 0;  // the base among them
};

// `sequence` must have its bands, and the mesh and the sequence be snapped to `codings`. Fails
// where the sink does, or where the model is larger than a file can say, or when interrupted.
Result<EncodedModel> encode_model(const Mesh& snapped, const ContractionSequence& sequence,
                                  std::span<const LayerCoding> codings, ByteSink& sink,
                                  const ProgressCallback& progress = {});

}  // namespace crease
