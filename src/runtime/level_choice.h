// At which level each block of a cut by block is shown, and what is known of their levels.
//
//   LevelChoice levels(graph);
//   levels.insert(block_levels);                      // whenever some have come
//   if (levels.choose(cut, view_error, keep)) ...     // blocks are shown at other ones
//   levels.shown(block)                               // 0: by coarser blocks
//
// Fine blocks decide first: one that shows anything wants all fine ends that it starts from. Each
// takes the coarsest level whose error is not seen to be too large; those that are not known yet
// are shown whole, and so are levels of which no list is there, or the next finer one that is.
// Time: O(cut). Memory: 8 bytes a vertex of a block's coarse end, and the lists.
#pragma once

#include "runtime/block_graph.h"
#include "runtime/block_levels.h"
#include "runtime/view_error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease {

// Of a LevelsLeft.
struct LeftAtLevels {
  const RoundedUp *off = nullptr, *degrees = nullptr;
  std::size_t count = 0;
};

class LevelChoice {
 public:
  // What is no longer needed goes to `unused`.
  LevelChoice(const BlockGraph& graph, std::vector<UnusedPtr>& unused)
      : graph_(graph), unused_(unused) {}

  // Of a block that is resident. What is shown does not change until the next choice.
  void insert(BlockLevelsPtr levels);
  // What was inserted counts from here on; else from the next choice.
  void take_waiting();
  void drop(std::uint32_t block);  // it is not resident any more
  // Lists that were not shown for so many choices, or at all in the last one. True if any.
  bool drop_lists(std::uint32_t age);

  // `cut`: ascending. `keep`: the error under which a level is given up for a coarser one. True if
  // what is shown has changed.
  bool choose(std::span<const std::uint32_t> cut, const ViewError& error, float keep);
  // At these, per block, which have at most so many triangles together. Until their lists are there
  // at finer ones or, if those are too many, at coarser ones.
  bool show_at(std::span<const std::uint32_t> cut, std::span<const std::uint8_t> levels,
               std::size_t max_triangles);
  // All of the cut whole.
  bool choose_whole(std::span<const std::uint32_t> cut);

  int shown(std::uint32_t block) const { return block < states_.size() ? states_[block].shown : 0; }
  // Null: it is shown whole, or not.
  const LevelList* list(std::uint32_t block) const {
    return block < states_.size() ? states_[block].list : nullptr;
  }
  // Of that list.
  std::uint64_t revision(std::uint32_t block) const { return states_[block].revision; }
  // How wrong the block is as it is shown; `coarse`: where levels are not known, of its coarse end.
  LevelError left(std::uint32_t block, const LevelError& coarse) const;

  // And where, as far as that is known. `level`: kFullLevel is right.
  std::vector<ErrorSphere> errors(std::uint32_t block, int level) const;

  bool is_known(std::uint32_t block) const {
    return block < states_.size() && states_[block].is_known;
  }
  // It is, and by all that is known of finer ones.
  bool is_settled(std::uint32_t block) const { return is_known(block) && !states_[block].is_stale; }
  // Of those that are known: whether they have levels, and what these have. `level` < kFullLevel.
  bool can_choose(std::uint32_t block) const { return states_[block].can_choose; }
  std::uint32_t triangles_at(std::uint32_t block, int level) const {
    return entries_[block].facts->triangles[static_cast<std::size_t>(level)];
  }
  // As it is seen: 1 is just what is allowed.
  float error_at(std::uint32_t block, int level, const ViewError& error) const;

  LevelFactsPtr facts(std::uint32_t block) const {
    return block < entries_.size() ? entries_[block].facts : nullptr;
  }
  int wanted(std::uint32_t block) const {
    return block < states_.size() ? states_[block].wanted : 0;
  }
  // The level that hysteresis keeps.
  int chosen(std::uint32_t block) const {
    return block < states_.size() ? states_[block].chosen : 0;
  }
  // As BlockMesh::missing_levels(), of those of the last choose().
  void list_missing(std::span<const std::uint32_t> cut, std::vector<BlockId>& missing) const;
  std::size_t bytes_of(std::uint32_t block) const;
  // Blocks of which bytes_of() is another since this was asked last.
  std::vector<std::uint32_t> take_resized() { return std::exchange(resized_, {}); }

 private:
  struct Entry {
    LevelFactsPtr facts;
    std::array<LevelListPtr, kFullLevel> lists;        // per level; that of 0 is none
    std::array<std::uint32_t, kFullLevel> shown_at{};  // the last choice; not of what is shown
  };
  // What each choice looks at of every block of the cut.
  struct State {
    const LevelList* list = nullptr;           // that is shown
    std::uint64_t revision = 0;                // its own
    std::uint32_t needed_at = 0, seen_at = 0;  // the last choice that had it so
    std::uint8_t wanted = 0, shown = 0;
    // What the last choice wanted by the block's own errors, as they are known now; or 0.
    std::uint8_t chosen = 0;
    std::uint16_t lists = 0;  // a bit per level: its list is there
    bool is_known = false;
    bool can_choose = false;  // it is, and the block is not always whole
    bool is_stale = false;    // of finer blocks more is known now
  };

  // Of those that can choose, what mostly tells the level; the rest is in the facts.
  struct Looked {
    LevelSphere whole;                                   // as the file tells it
    std::array<RoundedUp, kFullLevel> off{}, degrees{};  // of the whole block
    // Without parts, one that is wrong at the coarse end, and the one that needed the finest level.
    std::uint32_t wrong_at_coarse_end = kNone, wrong_piece = kNone;
    std::uint32_t first_inner = 0;        // as in LevelFacts
    std::span<const LevelSphere> pieces;  // as in LevelFacts
    LeftAtLevels left{};
  };
  struct View {
    const ViewError& error;
    ViewError::Reaches keep, at_all;  // under the one a level is given up, above the other refined
  };

  void take(const BlockLevels& levels);
  template <typename Pointer>
  void discard(Pointer& pointer) {
    if (pointer) unused_.push_back(std::exchange(pointer, nullptr));
  }
  void discard_lists(Entry& entry);
  bool lacks_finer(std::uint32_t block) const;
  int wanted_level(std::uint32_t block, const View& view);
  static int coarsest_right(const Looked& looked, std::uint32_t& wrong_piece,
                            const ViewError& error, const ViewError::Reaches& reaches, int level,
                            int end);
  void fetch(std::uint32_t block) const;
  void look_at(std::uint32_t block, const LevelFacts& facts);
  static void set_list(State& state, const LevelList* list);
  static const LevelList* list_at(const Entry& entry, int level);
  static int level_at_hand(const State& state, int level);
  static int coarser_at_hand(const State& state, int level);
  template <typename AtHand>
  std::int64_t plan(std::span<const std::uint32_t> cut, std::span<const std::uint8_t> levels,
                    AtHand at_hand);
  std::int64_t hide_finest(std::span<const std::uint32_t> cut, std::int64_t triangles,
                           std::int64_t max_triangles);
  std::int64_t more_triangles(std::uint32_t block, int level) const;
  void grow(std::size_t blocks);
  bool show(std::uint32_t block, int level);
  void change(std::uint32_t block, int level);
  bool begin_choice(std::span<const std::uint32_t> cut);
  bool hide_others();

  const BlockGraph& graph_;
  std::vector<UnusedPtr>& unused_;
  std::vector<Entry> entries_;  // per block
  std::vector<State> states_;   // likewise
  std::vector<Looked> looked_;
  std::vector<std::uint32_t> was_shown_, is_shown_;
  std::vector<std::uint8_t> planned_;  // per block of the cut, while levels are given
  std::vector<char> is_needed_;        // per block, likewise
  std::vector<std::uint32_t> resized_;
  std::vector<BlockLevelsPtr> waiting_;  // one of a block: choices may be long in coming
  bool lists_have_changed_ = false;
  std::uint32_t choices_ = 0;
};

}  // namespace crease
