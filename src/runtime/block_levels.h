// A block between its two ends, by block: some meshes of all of it that are coarser than the fine
// end, each right within a share of what the coarse end is wrong by.
//
// A file's bands are a factor of three apart. Where a block is shown because its coarse end is seen
// to be wrong by little more than is allowed, its fine end has three times the triangles that are
// needed. Level k has those splits done whose errors are above kLevelRatio^k of the coarse end's,
// the largest: a cut of the block's hierarchy as any, and so without a crack beside whatever is
// shown around it. Level 0 is the coarse end and kFullLevel the fine one.
//
// The hierarchy that this takes is made for the job and not kept. What is kept of it is what each
// level leaves, how wrong the vertices of the coarse end are (for the blocks that made them, as in
// BlockErrors), and one draw list of each level that has been wanted.
#pragma once

#include "crease/block_mesh.h"
#include "runtime/level_list.h"
#include "runtime/resident_block.h"
#include "runtime/rounded_error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace crease {

inline constexpr int kFullLevel = 14;
inline constexpr double kLevelRatio = 0.8;

// A piece of the block, around some vertices of its coarse end: the sphere that holds all that is
// below them.
struct LevelPiece {
  Vec3f center;  // from the grid's origin, model units
  RoundedUp radius;
  std::uint16_t next = 0;  // the first one that is no part of it
};

struct LevelFacts {
  std::array<LevelError, kFullLevel> left;  // per level but the full one: the largest
  std::vector<RoundedError> of_root;        // empty: the block has no hierarchy
  // A tree: all of the block, then its first half with the parts of that, and so on. A level is
  // right where it is in all that have no parts.
  std::vector<LevelPiece> pieces;
  std::vector<RoundedError> left_in_piece;  // of all pieces at level 0, then at level 1, and so on

  SplitBounds bounds_of_piece(int level, std::size_t piece) const {
    SplitBounds bounds;
    bounds.radius = pieces[piece].radius;
    set_error(bounds, left_in_piece[static_cast<std::size_t>(level) * pieces.size() + piece]);
    return bounds;
  }
};

using LevelFactsPtr = std::shared_ptr<const LevelFacts>;

struct BlockLevels::Data {
  BlockId id{};
  LevelFactsPtr facts;
  LevelListPtr list;  // or null
};

struct BlockLevelsJob::Data {
  ResidentBlockPtr block;
  std::vector<ResidentBlockPtr> needed;  // ascending
  struct Finer {
    ResidentBlockPtr block;
    LevelFactsPtr facts;
  };
  std::vector<Finer> finer;  // blocks that need it and of which something is known
  int level = 0;             // of which a list is wanted
};

}  // namespace crease
