// What holds for all blocks of a file, and one block by it.
//
//   Result<ModelSchema> schema = read_schema(file);
//   Result<DecodedBlock> block = decode_block_of(*schema, entry, payload, start);
#pragma once

#include "codec/decode_block.h"
#include "codec/layer_coding.h"
#include "crease/block_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace crease::codec {

struct ModelSchema {
  ModelFacts facts;
  std::vector<LayerCoding> codings;  // per layer
  std::vector<Material> materials;
  std::vector<std::string> parts;  // or empty, while names are not known
  BlockCoding coding;
};

// Reads the tables and materials. The names of parts lie at the file's end and are left out.
Result<ModelSchema> read_schema(const BlockFile& file);

// "block 7: " and what is wrong with it.
Failure bad_block(BlockId id, const char* what);

// As the entry promises, or a failure that names the block. Whether the vertices that it names are
// there is left to the caller.
Result<DecodedBlock> decode_block_of(const ModelSchema& schema, const BlockEntry& entry,
                                     std::span<const std::byte> payload, CoarseEnd start,
                                     StreamBits* bits = nullptr);

}  // namespace crease::codec
