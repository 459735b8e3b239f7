// What a block shows at a level between its ends (runtime/block_levels.h).
#pragma once

#include "crease/packed_indices.h"
#include "runtime/active_cut.h"
#include "runtime/block_hierarchy.h"
#include "runtime/resident_block.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crease {

// Three-part arrays of its own, group by group.
struct LevelList {
  int level = 0;
  std::vector<std::uint64_t> done;  // a bit per split of the hierarchy that the job made
  std::vector<Vec3f> positions, vertex_normals;
  BlockPart sn, fn, nsn;
  std::vector<BlockGroup> groups;  // of no patch
  std::uint64_t revision = 0;

  std::size_t bytes() const;
};
using LevelListPtr = std::shared_ptr<const LevelList>;

// `done`: as LevelList::done.
LevelListPtr make_level_list(const ResidentBlock::Data& block, const BlockHierarchy::Data& data,
                             int level, std::vector<std::uint64_t> done);

// The cut of a level through the block's hierarchy.
void split_as(const LevelList& list, ActiveCut& cut);

}  // namespace crease
