// The lattices of layers with AttributeCoding::Lattice, which lie in a file's model tables.
#pragma once

#include "codec/layer_coding.h"
#include "crease/block_file.h"
#include "crease/result.h"

#include <cstddef>
#include <span>
#include <vector>

namespace crease {

// The coding of every layer of the schema. Fails where the tables are not what the schema needs:
// a divisor, a range or an entry that is none, too few bytes or too many.
Result<std::vector<LayerCoding>> decode_codings(std::span<const LayerSchema> layers,
                                                std::span<const std::byte> tables);

}  // namespace crease
