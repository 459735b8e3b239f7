// Plans -> blocks, coarsest first.
#pragma once

#include "pipeline/plan_blocks.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

struct CodedBlock {
  std::uint32_t band = 0;  // 0: the base; finer ones follow
  std::uint32_t patch = 0;
  codec::BlockLimits limits;                // the counts at its fine end
  std::vector<std::uint32_t> dependencies;  // ids of the blocks that it starts from, ascending
  std::vector<std::byte> bytes;
};

// Block i of the result has the id i.
std::vector<CodedBlock> encode_blocks(const std::vector<BandPlans>& plans,
                                      const codec::BlockCoding& coding);

}  // namespace crease
