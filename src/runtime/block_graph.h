// The blocks of a file and which need which, as directory pages tell, with bounds for a search from
// the coarse ones on.
#pragma once

#include "runtime/block_bounds.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease {

class BlockGraph {
 public:
  BlockGraph(const ModelFacts& facts, std::uint32_t block_count);

  // Pages come in order, as a whole: of one that fails nothing is added.
  std::uint32_t pages_added() const { return pages_; }
  Status add_page(const DirectoryPage& page);

  std::uint32_t size() const { return static_cast<std::uint32_t>(nodes_.size()); }
  const BlockEntry& entry(std::uint32_t block) const { return nodes_[block].entry; }
  std::span<const std::uint32_t> dependencies(std::uint32_t block) const {
    return nodes_[block].dependencies;
  }
  std::span<const std::uint32_t> dependents(std::uint32_t block) const {
    return nodes_[block].dependents;
  }
  // Those that need none: the base, and what vanishes before there is anything coarser.
  std::span<const std::uint32_t> starts() const { return starts_; }
  bool is_base(std::uint32_t block) const { return entry(block).facts.band == patches_.size(); }
  // The block that goes on with `patch` where a block of `band` ends; kNone: none.
  std::uint32_t next_finer(std::uint16_t band, std::uint32_t patch) const;

  // Of the block at its coarse end.
  const BlockBounds& own(std::uint32_t block) const { return nodes_[block].own; }
  // Of it and of all known blocks that need it: where these are right, so are all of those.
  const BlockBounds& all(std::uint32_t block) const { return nodes_[block].all; }

 private:
  struct Node {
    BlockEntry entry;
    std::vector<std::uint32_t> dependencies, dependents;
    BlockBounds own, all;
  };

  Status check(const DirectoryPage& page) const;
  void grow_bounds();

  Grid grid_;
  std::vector<std::uint32_t> first_of_band_, patches_;  // per band, finest first
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> starts_;
  std::uint32_t pages_ = 0;
};

}  // namespace crease
