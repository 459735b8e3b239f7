// Which blocks a view gets, and at which levels, where it may have only so many triangles.
//
//   TriangleBudget budget(graph);
//   budget.spend(wrong, terms);
//   for (const std::uint32_t block : budget.chosen()) ... budget.levels()[block] ...
//
// The most visible error is mended first: its block goes to the next level at which it is less, and
// all that this starts from to the fine end. That is done step by step until there are far too many
// triangles; and then as far as there were not too many for the last time, since on the way there
// may be more than later: at its first levels a block has less than half of what it starts from.
// From there on steps that do not fit are passed over.
//
// Levels count with the triangles that they have. Of a block that is not known yet they are guessed
// to be few, so that it is chosen, and is known then.
//
// Time: O(steps * log(blocks)); a block takes at most one a level.
#pragma once

#include "runtime/block_graph.h"
#include "runtime/level_choice.h"
#include "runtime/view_error.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

// A block as a view sees its coarse end.
struct SeenBlock {
  // 1: just what is allowed; infinite: the base. Seen from a twentieth of the sphere's radius
  // away, if the eye is nearer. 0 where all are chosen, and nobody asks.
  float error = 0;
  std::uint32_t block = 0;
};

class TriangleBudget {
 public:
  explicit TriangleBudget(const BlockGraph& graph) : graph_(graph) {}

  struct Terms {
    const ViewError& error;
    std::size_t max_triangles = 0, max_bytes = 0;
    std::span<const std::size_t> bytes_of_block;
    const LevelChoice* levels = nullptr;  // null: blocks are whole or not there
  };
  void spend(std::span<const SeenBlock> wrong, const Terms& terms);

  // What a block needs before it; the most visible first.
  std::span<const std::uint32_t> chosen() const { return chosen_; }
  // Per block: at which it fits. 0: it may be there, but shows nothing.
  std::span<const std::uint8_t> levels() const { return levels_; }

 private:
  struct Step {
    float error = 0;
    std::uint32_t block = 0;
    int level = 0;  // from this one on; or kOutside
  };
  static constexpr int kOutside = -1;

  void begin(std::span<const SeenBlock> wrong);
  void take_step(const Terms& terms);
  void push(const Step& step);
  void enter(const Step& step, const Terms& terms);
  void raise(const Step& step, const Terms& terms);
  bool exceeds(std::size_t times, const Terms& terms) const;
  bool fits(std::int64_t more, const Terms& terms) const;
  bool is_whole(std::uint32_t block, const Terms& terms) const;
  float error_at(std::uint32_t block, int level, const Terms& terms) const;
  std::int64_t more_at(std::uint32_t block, int level, const Terms& terms) const;
  template <typename IsThere>
  void collect_needed(std::uint32_t block, IsThere is_there);
  std::int64_t collect_coarse(std::uint32_t block, const Terms& terms);

  const BlockGraph& graph_;
  std::vector<std::uint8_t> levels_;   // per block
  std::vector<char> is_chosen_;        // per block
  std::vector<float> seen_error_;      // per block, of those that are chosen for themselves
  std::vector<std::uint64_t> met_at_;  // per block: the last search that met it
  std::uint64_t searches_ = 0;
  std::vector<Step> steps_;  // a heap
  std::vector<std::uint32_t> chosen_, found_;
  std::int64_t triangles_ = 0;
  std::size_t bytes_ = 0;
  bool is_limited_ = false;  // to steps that fit
  bool has_bytes_ = true;    // until a block is too large for what is left
};

}  // namespace crease
