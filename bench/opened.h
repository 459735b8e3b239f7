// A model as a program has it that opened its file.
#pragma once

#include "crease/decode_model.h"
#include "crease/mesh.h"
#include "crease/result.h"

#include <cstddef>

namespace crease::bench {

struct Opened {
  DecodedModel model;
  std::size_t file_bytes = 0;
};

// Builds with the defaults and decodes the whole.
Result<Opened> open_built(Mesh mesh);

}  // namespace crease::bench
