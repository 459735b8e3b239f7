// Plans -> blocks, coarsest first.
#pragma once

#include "crease/block_file.h"
#include "crease/progress.h"
#include "crease/result.h"
#include "pipeline/plan_blocks.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

struct CodedBlock {
  BlockFacts facts;                   // its band is the file's: the base has the greatest number
  std::vector<BlockId> dependencies;  // the blocks that it starts from, ascending
  std::vector<std::byte> bytes;
  codec::BlockLimits limits() const { return {facts.vertices, facts.triangles_fine}; }
};

// Block i of the result has the id i. `plans`: the base first; each band is gone once it is
// encoded. The blocks of a band on all threads. `progress` is told of "encode", and fails it.
Result<std::vector<CodedBlock>> encode_blocks(std::vector<BandPlans> plans,
                                              const codec::BlockCoding& coding,
                                              const ProgressCallback& progress = {});

}  // namespace crease
