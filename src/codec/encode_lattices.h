// The model tables of a file: see codec/lattices.h.
#pragma once

#include "codec/layer_coding.h"

#include <cstddef>
#include <span>
#include <vector>

namespace crease {

std::vector<std::byte> encode_lattices(std::span<const LayerCoding> codings);

}  // namespace crease
