// The blocks of a file decoded one after the other, and nothing else: what the bits themselves
// cost, without a model being made of them.
//
//   Result<BareBlocks> blocks = decode_bare_blocks(file);
#pragma once

#include "crease/block_file.h"
#include "crease/result.h"

#include <cstddef>

namespace crease::bench {

struct BareBlocks {
  double seconds = 0;  // of this thread's processor time, in codec::decode_block() alone
  std::size_t blocks = 0;
};
Result<BareBlocks> decode_bare_blocks(const BlockFile& file);

// Of this thread, whatever else the machine does.
double processor_seconds();

}  // namespace crease::bench
