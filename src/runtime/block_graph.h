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

  std::uint32_t size() const { return static_cast<std::uint32_t>(entries_.size()); }
  const BlockEntry& entry(std::uint32_t block) const { return entries_[block]; }
  std::span<const std::uint32_t> dependencies(std::uint32_t block) const {
    return dependencies_.of(block);
  }
  std::span<const std::uint32_t> dependents(std::uint32_t block) const {
    return dependents_.of(block);
  }
  // Those that need none: the base, and what vanishes before there is anything coarser.
  std::span<const std::uint32_t> starts() const { return starts_; }
  // The first one alone, if it is of the coarsest band.
  bool is_base(std::uint32_t block) const { return block == base_; }
  // The block that goes on with `patch` where a block of `band` ends; kNone: none.
  std::uint32_t next_finer(std::uint16_t band, std::uint32_t patch) const;

  // Of the block at its coarse end.
  const BlockBounds& own(std::uint32_t block) const { return bounds_[block].own; }
  // Of it and of all known blocks that need it: where these are right, so are all of those.
  const BlockBounds& all(std::uint32_t block) const { return bounds_[block].all; }
  // By so many more than its coarse end its fine end has.
  std::uint32_t more_triangles(std::uint32_t block) const { return more_triangles_[block]; }

 private:
  struct Bounds {
    BlockBounds own, all;
  };
  // Of each block some others.
  struct Links {
    std::vector<std::uint32_t> begin{0}, blocks;
    std::span<const std::uint32_t> of(std::uint32_t block) const {
      return std::span(blocks).subspan(begin[block], begin[block + 1] - begin[block]);
    }
  };

  Status check(const DirectoryPage& page) const;
  void find_dependents();
  void grow_bounds();

  Grid grid_;
  std::vector<std::uint32_t> first_of_band_, patches_;  // per band, finest first
  // Per block; what a search looks at lies apart from what a file tells.
  std::vector<BlockEntry> entries_;
  std::vector<Bounds> bounds_;
  std::vector<std::uint32_t> more_triangles_;
  Links dependencies_, dependents_;
  std::vector<std::uint32_t> starts_;
  std::uint32_t base_ = kNone;
  std::uint32_t pages_ = 0;
};

}  // namespace crease
