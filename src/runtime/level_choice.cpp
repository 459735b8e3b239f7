#include "runtime/level_choice.h"

#include <algorithm>
#include <utility>

namespace crease {

void LevelChoice::take_waiting() {
  for (const BlockLevelsPtr& levels : std::exchange(waiting_, {})) take(*levels);
}

void LevelChoice::take(const BlockLevels& levels) {
  const auto block = static_cast<std::uint32_t>(index_of(levels.id()));
  if (block >= entries_.size()) entries_.resize(block + 1);
  Entry& entry = entries_[block];
  const BlockLevels::Data& data = levels.data();
  const bool is_news = !entry.facts || entry.facts->of_root != data.facts->of_root;
  entry.is_stale = false;
  resized_.push_back(block);
  if (is_news) {
    // Lists of before are good still, but finer than they need be.
    entry.lists = {};
    entry.facts = data.facts;
    for (const std::uint32_t coarser : graph_.dependencies(block)) {
      if (coarser < entries_.size()) entries_[coarser].is_stale = true;
    }
  }
  entry.facts = data.facts;
  for (std::size_t k = 0; k < kFullLevel; ++k) {
    const RoundedError left = RoundedError::from(data.facts->left[k]);
    entry.bounds[k] = graph_.own(block).bounds;
    entry.bounds[k].surface = left.surface;
    entry.bounds[k].line = left.line;
    entry.bounds[k].degrees = left.degrees;
    entry.bounds[k].texture = left.texture;
  }
  if (data.list) {
    entry.lists[static_cast<std::size_t>(data.list->level)] = data.list;
    entry.shown_at[static_cast<std::size_t>(data.list->level)] = choices_;
  }
}

void LevelChoice::drop(std::uint32_t block) {
  if (block >= entries_.size()) return;
  entries_[block] = {};
  resized_.push_back(block);
}

bool LevelChoice::drop_lists(std::uint64_t age) {
  bool any = false;
  for (std::uint32_t block = 0; block < entries_.size(); ++block) {
    Entry& entry = entries_[block];
    for (std::size_t k = 1; k < kFullLevel; ++k) {
      if (!entry.lists[k] || entry.shown == k || entry.shown_at[k] + age > choices_) continue;
      entry.lists[k] = nullptr;
      resized_.push_back(block);
      any = true;
    }
  }
  return any;
}

int LevelChoice::wanted_level(std::uint32_t block, const ViewError& error, float keep) {
  Entry& entry = entries_[block];
  if (!entry.facts || entry.facts->of_root.empty() || graph_.is_base(block)) return kFullLevel;
  int level = std::min<int>(entry.wanted, kFullLevel);
  while (level > 0 && !is_wrong(block, level - 1, error, keep)) --level;
  if (level < entry.wanted) return level;
  while (level < kFullLevel && is_wrong(block, level, error, 1)) ++level;
  return level;
}

// Mostly the piece that was wrong the last time is still.
bool LevelChoice::is_wrong(std::uint32_t block, int level, const ViewError& error, float limit) {
  Entry& entry = entries_[block];
  const auto k = static_cast<std::size_t>(level);
  if (error.of(entry.bounds[k], graph_.own(block).center) <= limit) return false;
  const std::vector<LevelPiece>& pieces = entry.facts->pieces;
  const auto is_piece_wrong = [&](std::size_t i) {
    return error.of(pieces[i].left[k], pieces[i].center) > limit;
  };
  if (entry.wrong_piece < pieces.size() && is_piece_wrong(entry.wrong_piece)) return true;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!is_piece_wrong(i)) continue;
    entry.wrong_piece = static_cast<std::uint8_t>(i);
    return true;
  }
  return false;
}

// It, or the next finer one that is there.
int LevelChoice::level_at_hand(const Entry& entry, int level) const {
  while (level > 0 && level < kFullLevel && !entry.lists[std::size_t(level)]) ++level;
  return level;
}

bool LevelChoice::choose(std::span<const std::uint32_t> cut, const ViewError& error, float keep) {
  ++choices_;
  take_waiting();
  if (!cut.empty() && cut.back() >= entries_.size()) entries_.resize(cut.back() + 1);
  is_shown_.swap(was_shown_);
  is_shown_.clear();
  bool has_changed = false;
  for (std::size_t i = cut.size(); i-- > 0;) {
    const std::uint32_t block = cut[i];
    Entry& entry = entries_[block];
    const bool is_needed = entry.needed_at == choices_;
    const int level = is_needed ? kFullLevel : wanted_level(block, error, keep);
    entry.wanted = static_cast<std::uint8_t>(level);
    has_changed |= show(block, level_at_hand(entry, level));
    if (entry.shown == 0) continue;
    for (const std::uint32_t needed : graph_.dependencies(block)) {
      entries_[needed].needed_at = choices_;
    }
  }
  return hide_others() || has_changed;
}

bool LevelChoice::choose_whole(std::span<const std::uint32_t> cut) {
  ++choices_;
  take_waiting();
  if (!cut.empty() && cut.back() >= entries_.size()) entries_.resize(cut.back() + 1);
  is_shown_.swap(was_shown_);
  is_shown_.clear();
  bool has_changed = false;
  for (const std::uint32_t block : cut) {
    entries_[block].wanted = kFullLevel;
    has_changed |= show(block, kFullLevel);
  }
  return hide_others() || has_changed;
}

bool LevelChoice::show(std::uint32_t block, int level) {
  Entry& entry = entries_[block];
  const bool has_changed = entry.shown != level;
  entry.shown = static_cast<std::uint8_t>(level);
  entry.seen_at = choices_;
  if (level > 0) is_shown_.push_back(block);
  if (level % kFullLevel != 0) entry.shown_at[std::size_t(level)] = choices_;
  return has_changed;
}

// Those that the cut no longer goes through.
bool LevelChoice::hide_others() {
  bool any = false;
  for (const std::uint32_t block : was_shown_) {
    Entry& entry = entries_[block];
    if (entry.seen_at == choices_ || entry.shown == 0) continue;
    entry.shown = entry.wanted = 0;
    any = true;
  }
  return any;
}

LevelError LevelChoice::left(std::uint32_t block, const LevelError& coarse) const {
  const int level = shown(block);
  if (level == kFullLevel) return {};
  const LevelFactsPtr known = facts(block);
  if (!known || known->of_root.empty()) return coarse;
  return known->left[std::size_t(level)];
}

void LevelChoice::list_missing(std::span<const std::uint32_t> cut,
                               std::vector<BlockId>& missing) const {
  missing.clear();
  std::vector<BlockId> stale;
  for (std::size_t i = cut.size(); i-- > 0;) {
    if (graph_.is_base(cut[i])) continue;
    const Entry& entry = entries_[cut[i]];
    const bool lacks_list = entry.wanted % kFullLevel != 0 && !entry.lists[entry.wanted];
    if (!entry.facts || lacks_list) {
      missing.push_back(graph_.entry(cut[i]).id);
    } else if (entry.is_stale) {
      stale.push_back(graph_.entry(cut[i]).id);
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
             sizeof(LevelPiece) * entry.facts->pieces.capacity();
  }
  for (const LevelListPtr& list : entry.lists) bytes += list ? list->bytes() : 0;
  return bytes;
}

}  // namespace crease
