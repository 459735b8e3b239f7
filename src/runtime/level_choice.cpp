#include "runtime/level_choice.h"

#include <algorithm>
#include <utility>

namespace crease {

static_assert(kFullLevel <= 16, "a bit of State::lists each");

void LevelChoice::grow(std::size_t blocks) {
  if (blocks <= states_.size()) return;
  entries_.resize(blocks);
  states_.resize(blocks);
}

void LevelChoice::take_waiting() {
  for (const BlockLevelsPtr& levels : std::exchange(waiting_, {})) take(*levels);
}

void LevelChoice::take(const BlockLevels& levels) {
  const auto block = static_cast<std::uint32_t>(index_of(levels.id()));
  grow(std::size_t(block) + 1);
  Entry& entry = entries_[block];
  State& state = states_[block];
  const BlockLevels::Data& data = levels.data();
  if (!entry.facts || entry.facts->of_root != data.facts->of_root) {
    // Lists of before are good still, but finer than they need be.
    entry.lists = {};
    state.lists = 0;
    for (const std::uint32_t coarser : graph_.dependencies(block)) {
      if (coarser < states_.size()) states_[coarser].is_stale = true;
    }
  }
  entry.facts = data.facts;
  state.is_known = true;
  state.can_choose = !data.facts->of_root.empty() && !graph_.is_base(block);
  state.is_stale = false;
  for (std::size_t k = 0; k < kFullLevel; ++k) {
    entry.bounds[k] = graph_.own(block).bounds;
    set_error(entry.bounds[k], RoundedError::from(data.facts->left[k]));
  }
  if (data.list) {
    const auto level = static_cast<std::size_t>(data.list->level);
    entry.lists[level] = data.list;
    entry.shown_at[level] = choices_;
    state.lists = static_cast<std::uint16_t>(state.lists | 1u << level);
  }
  resized_.push_back(block);
  lists_have_changed_ = true;
}

void LevelChoice::drop(std::uint32_t block) {
  if (block >= states_.size()) return;
  entries_[block] = {};
  states_[block] = {};
  resized_.push_back(block);
}

bool LevelChoice::drop_lists(std::uint32_t age) {
  bool any = false;
  for (std::uint32_t block = 0; block < states_.size(); ++block) {
    State& state = states_[block];
    if (state.lists == 0) continue;
    Entry& entry = entries_[block];
    for (std::size_t k = 1; k < kFullLevel; ++k) {
      if (!entry.lists[k] || state.shown == k || entry.shown_at[k] + age > choices_) continue;
      entry.lists[k] = nullptr;
      state.lists = static_cast<std::uint16_t>(state.lists & ~(1u << k));
      resized_.push_back(block);
      any = true;
    }
  }
  return any;
}

int LevelChoice::wanted_level(std::uint32_t block, const ViewError& error, float keep) {
  const State& state = states_[block];
  if (!state.can_choose) return kFullLevel;
  int level = state.wanted;
  while (level > 0 && !is_wrong(block, level - 1, error, keep)) --level;
  if (level < state.wanted) return level;
  while (level < kFullLevel && is_wrong(block, level, error, 1)) ++level;
  return level;
}

// Mostly the piece that was wrong the last time is still.
bool LevelChoice::is_wrong(std::uint32_t block, int level, const ViewError& error, float limit) {
  const Entry& entry = entries_[block];
  const auto k = static_cast<std::size_t>(level);
  if (error.of(entry.bounds[k], graph_.own(block).center) <= limit) return false;
  const LevelFacts& facts = *entry.facts;
  const auto is_piece_wrong = [&](std::size_t i) {
    return error.of(facts.bounds_of_piece(level, i), facts.pieces[i].center) > limit;
  };
  std::uint8_t& last = states_[block].wrong_piece;
  const auto has_parts = [&](std::size_t i) { return facts.pieces[i].next > i + 1; };
  if (last < facts.pieces.size() && !has_parts(last) && is_piece_wrong(last)) return true;
  for (std::size_t i = 0; i < facts.pieces.size();) {
    if (!is_piece_wrong(i)) {
      i = facts.pieces[i].next;
    } else if (has_parts(i)) {
      ++i;
    } else {
      last = static_cast<std::uint8_t>(i);
      return true;
    }
  }
  return false;
}

// It, or the next finer one that is there.
int LevelChoice::level_at_hand(const State& state, int level) {
  while (level > 0 && level < kFullLevel && (state.lists >> level & 1) == 0) ++level;
  return level;
}

// Whether lists have come.
bool LevelChoice::begin_choice(std::span<const std::uint32_t> cut) {
  ++choices_;
  take_waiting();
  if (!cut.empty()) grow(std::size_t(cut.back()) + 1);
  is_shown_.swap(was_shown_);
  is_shown_.clear();
  return std::exchange(lists_have_changed_, false);
}

bool LevelChoice::choose(std::span<const std::uint32_t> cut, const ViewError& error, float keep) {
  bool has_changed = begin_choice(cut);
  for (std::size_t i = cut.size(); i-- > 0;) {
    const std::uint32_t block = cut[i];
    State& state = states_[block];
    const bool is_needed = state.needed_at == choices_;
    const int level = is_needed ? kFullLevel : wanted_level(block, error, keep);
    state.wanted = static_cast<std::uint8_t>(level);
    has_changed |= show(block, level_at_hand(state, level));
    if (state.shown == 0) continue;
    for (const std::uint32_t needed : graph_.dependencies(block)) {
      states_[needed].needed_at = choices_;
    }
  }
  return hide_others() || has_changed;
}

bool LevelChoice::choose_whole(std::span<const std::uint32_t> cut) {
  bool has_changed = begin_choice(cut);
  for (const std::uint32_t block : cut) {
    states_[block].wanted = kFullLevel;
    has_changed |= show(block, kFullLevel);
  }
  return hide_others() || has_changed;
}

bool LevelChoice::show(std::uint32_t block, int level) {
  State& state = states_[block];
  const bool has_changed = state.shown != level;
  state.shown = static_cast<std::uint8_t>(level);
  state.seen_at = choices_;
  if (level > 0) is_shown_.push_back(block);
  if (level % kFullLevel != 0) entries_[block].shown_at[std::size_t(level)] = choices_;
  return has_changed;
}

// Those that the cut no longer goes through.
bool LevelChoice::hide_others() {
  bool any = false;
  for (const std::uint32_t block : was_shown_) {
    State& state = states_[block];
    if (state.seen_at == choices_ || state.shown == 0) continue;
    state.shown = state.wanted = 0;
    any = true;
  }
  return any;
}

LevelError LevelChoice::left(std::uint32_t block, const LevelError& coarse) const {
  const int level = shown(block);
  if (level == kFullLevel) return {};
  if (block >= states_.size() || !states_[block].can_choose) return coarse;
  return entries_[block].facts->left[std::size_t(level)];
}

void LevelChoice::list_missing(std::span<const std::uint32_t> cut,
                               std::vector<BlockId>& missing) const {
  std::vector<BlockId> stale;
  for (std::size_t i = cut.size(); i-- > 0;) {
    const State& state = states_[cut[i]];
    const bool lacks_list =
        state.wanted % kFullLevel != 0 && (state.lists >> state.wanted & 1) == 0;
    if (!state.is_known || lacks_list) {
      if (!graph_.is_base(cut[i])) missing.push_back(BlockId{cut[i]});
    } else if (state.is_stale) {
      stale.push_back(BlockId{cut[i]});
    }
  }
  missing.insert(missing.end(), stale.begin(), stale.end());
}

std::size_t LevelChoice::bytes_of(std::uint32_t block) const {
  if (block >= entries_.size()) return 0;
  const Entry& entry = entries_[block];
  std::size_t bytes = 0;
  if (entry.facts) {
    bytes += sizeof(LevelFacts) + sizeof(RoundedError) * entry.facts->of_root.capacity() +
             sizeof(LevelPiece) * entry.facts->pieces.capacity() +
             sizeof(RoundedError) * entry.facts->left_in_piece.capacity();
  }
  for (const LevelListPtr& list : entry.lists) bytes += list ? list->bytes() : 0;
  return bytes;
}

}  // namespace crease
