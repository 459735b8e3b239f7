// A block between its two ends, by block: some meshes of all of it that are coarser than the fine
// end, each right within a share of what the coarse end is wrong by.
//
// A file's bands are a factor of four in triangles apart. Where a block is shown because its coarse
// end is seen to be wrong by little more than is allowed, its fine end has four times those that
// are needed; and where only some of it is wrong, the rest of its coarse end is finer than need be.
// Level k has those splits done whose errors are above kLevelRatio^k of the coarse end's, the
// largest, of the block's own and of its inner ones (runtime/inner_splits.h): a cut of the block's
// hierarchy as any, and so without a crack beside whatever is shown around it. Level 0 is the
// coarse end, with all inner splits done, and kFullLevel the fine one. Errors get less from level
// to level, but from 0 to 1.
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
inline constexpr int kMostHalvings = 5;  // of a block into pieces, and of its inner splits

// Around some splits of a block, and all that is below them.
struct LevelSphere {
  Vec3f center;  // from the grid's origin, model units
  RoundedUp radius;
  std::uint16_t next = 0;  // of a piece: the first one that is no part of it
};

// How wrong things are at each level but the full one: of all of them at level 0, then at level 1,
// and so on, since a choice asks many things of one level or two.
struct LevelsLeft {
  std::size_t count = 0;                // things
  std::vector<RoundedUp> off, degrees;  // off: the larger one of surface and line

  explicit LevelsLeft(std::size_t things = 0)
      : count(things), off(kFullLevel * things), degrees(kFullLevel * things) {}
  void add(std::size_t thing, int level, const RoundedError& error) {
    const std::size_t at = static_cast<std::size_t>(level) * count + thing;
    off[at] = worse(off[at], worse(error.surface, error.line));
    degrees[at] = worse(degrees[at], error.degrees);
  }
};

// What was known of a finer block: which one, and a checksum of its LevelFacts::of_root.
struct KnownFiner {
  BlockId id{};
  std::uint64_t roots = 0;

  bool operator==(const KnownFiner&) const = default;
};

// Of a block, and what was known of the finer ones: nothing else tells them.
struct LevelFacts {
  std::array<LevelError, kFullLevel> left;            // per level but the full one: the largest
  std::array<std::uint32_t, kFullLevel> triangles{};  // likewise
  std::vector<RoundedError> of_root;                  // empty: the block has no hierarchy
  std::uint64_t roots = 0;                            // a checksum of these
  std::vector<KnownFiner> finer;                      // ascending
  // A tree: all of the block, then its first half with the parts of that, and so on. A level is
  // right where it is in all that have no parts.
  std::vector<LevelSphere> pieces;
  std::uint32_t first_inner =
      0;  // of those that are of inner splits alone, which are the last ones
  LevelsLeft left_in_piece;
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
