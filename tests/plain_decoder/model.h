// The plain decoder: a second decoder of model.crease, slow, after the documents alone:
// docs/format.md (container.*, model.*), docs/format-block.md (everything else) and
// docs/format-models.md (tables.h). A function does what one section there says, in the order of
// the document, and is named after it. It shares nothing with src/: no header, no type, no table;
// it needs the standard library and nothing else.
//
//   const plain::Model model = plain::decode_model(bytes_of_a_file);
//   for (const plain::Block& block : model.blocks) ...
//
// It is there for two ends. It is an oracle: the tests beside it hold every block of it against the
// codec's. And it shows that the documents are enough: where the two disagree with it, or it has to
// know what they do not say, the documents are mended.
//
// Plain means that what the document calls a list, an order or a sum over triangles is searched,
// sorted or summed where it is needed, that contexts of adaptive bits are maps, and that nothing is
// kept that can be asked for. Doubles must be IEEE doubles, no product fused with a sum
// (-ffp-contract=off), and float(x) must round.
//
// Where bytes are not what the documents say, it throws plain::Refused.
#pragma once

#include "plain_decoder/block.h"
#include "plain_decoder/container.h"

#include <vector>

namespace plain {

struct Model {
  Container container;
  BlockSchema schema;
  std::vector<std::vector<Lattice>> lattices;  // per layer
  std::vector<Block> blocks;                   // in the order of the file
  std::vector<End> coarse;                     // per block: what it started from
};

// The whole file, every checksum verified.
Model decode_model(const Bytes& file);

// What blocks have to know of the layers, materials and parts.
BlockSchema block_schema(const Container& container,
                         const std::vector<std::vector<Lattice>>& lattices);

}  // namespace plain
