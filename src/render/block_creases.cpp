#include "render/block_creases.h"

#include <utility>

namespace crease {

namespace {

bool is_within(const Range& range, const Range& whole) {
  return range.first >= whole.first && range.first + range.count <= whole.first + whole.count;
}

}  // namespace

BlockCreases creases_of(const ResidentBlock& block) {
  BlockCreases creases;
  const DrawList list = block.draw_list();
  for (const BlockGroup& group : block.groups()) {
    GroupLines found = lines_of(list, {group.sn, group.fn, group.nsn});
    creases.hard_of_group.push_back(
        {std::uint32_t(creases.hard.size()), std::uint32_t(found.hard.size())});
    creases.hard.insert(creases.hard.end(), found.hard.begin(), found.hard.end());
    creases.rim_of_group.push_back(std::move(found.rim));
  }
  return creases;
}

Range hard_of_run(const ShownRange& run, const BlockCreases& block,
                  std::vector<std::span<const RimEdge>>& rims) {
  Range hard{};
  const std::span<const BlockGroup> groups = run.block->groups();
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!is_within(groups[g].sn, run.sn) || !is_within(groups[g].fn, run.fn) ||
        !is_within(groups[g].nsn, run.nsn)) {
      continue;
    }
    rims.emplace_back(block.rim_of_group[g]);
    const Range& of_group = block.hard_of_group[g];
    if (hard.count == 0) hard.first = of_group.first;
    hard.count += of_group.count;
  }
  return hard;
}

}  // namespace crease
