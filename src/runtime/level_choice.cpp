#include "runtime/level_choice.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace crease {

static_assert(kFullLevel <= 16, "a bit of State::lists each");

namespace {

constexpr std::size_t kFetchedBefore = 3;  // so many blocks

// A thing as it is seen, good for all of its levels.
class Seen {
 public:
  Seen(const LevelSphere& sphere, const LeftAtLevels& left, std::size_t thing,
       const ViewError& error)
      : sphere_(sphere),
        left_(left),
        thing_(thing),
        error_(error),
        radius_(ViewError::decoded(sphere.radius)),
        distance2_(error.distance2(sphere.center)) {}

  bool is_wrong(int level, const ViewError::Reaches& reaches) const {
    return is_near(level, reaches) && error_.is_in_view(sphere_.center, radius_);
  }
  // The first level from `level` to `end` that is right, or else the end.
  int right_from(int level, int end, const ViewError::Reaches& reaches) const {
    if (level >= end || !is_wrong(level, reaches)) return level;
    do {
      ++level;
    } while (level < end && is_near(level, reaches));
    return level;
  }

 private:
  bool is_near(int level, const ViewError::Reaches& reaches) const {
    const std::size_t at = static_cast<std::size_t>(level) * left_.count + thing_;
    const float reach = error_.reach(left_.off[at], left_.degrees[at], radius_, reaches);
    return ViewError::is_near(reach, radius_, distance2_);
  }

  const LevelSphere& sphere_;
  const LeftAtLevels& left_;
  std::size_t thing_;
  const ViewError& error_;
  float radius_, distance2_;
};

}  // namespace

void LevelChoice::grow(std::size_t blocks) {
  if (blocks <= states_.size()) return;
  entries_.resize(blocks);
  states_.resize(blocks);
  looked_.resize(blocks);
}

void LevelChoice::insert(BlockLevelsPtr levels) {
  const auto same = std::find_if(waiting_.begin(), waiting_.end(),
                                 [&](const auto& other) { return other->id() == levels->id(); });
  if (same == waiting_.end()) return waiting_.push_back(std::move(levels));
  std::swap(*same, levels);
  discard(levels);
}

void LevelChoice::take_waiting() {
  for (BlockLevelsPtr& levels : waiting_) {
    take(*levels);
    discard(levels);
  }
  waiting_.clear();
}

void LevelChoice::take(const BlockLevels& levels) {
  const auto block = static_cast<std::uint32_t>(index_of(levels.id()));
  grow(std::size_t(block) + 1);
  Entry& entry = entries_[block];
  State& state = states_[block];
  const BlockLevels::Data& data = levels.data();
  if (!entry.facts || entry.facts->finer != data.facts->finer) {
    // Lists of before are right still, but finer than they need be; and what is shown of a view in
    // the end does not depend on what was known first.
    discard_lists(entry);
    state.lists = 0;
    state.chosen = 0;
  }
  discard(entry.facts);
  entry.facts = data.facts;
  state.is_known = true;
  state.can_choose = !data.facts->of_root.empty() && !graph_.is_base(block);
  state.is_stale = lacks_finer(block);
  for (const std::uint32_t coarser : graph_.dependencies(block)) {
    if (coarser < states_.size()) states_[coarser].is_stale = lacks_finer(coarser);
  }
  look_at(block, *data.facts);
  if (data.list) {
    const auto level = static_cast<std::size_t>(data.list->level);
    discard(entry.lists[level]);
    entry.lists[level] = data.list;
    entry.shown_at[level] = choices_;
    state.lists = static_cast<std::uint16_t>(state.lists | 1u << level);
  }
  set_list(state, list_at(entry, state.shown));
  resized_.push_back(block);
  lists_have_changed_ = true;
}

// Something is known of finer blocks that the facts were made without. Jobs end in any order, and
// one may have begun before what another one brought.
bool LevelChoice::lacks_finer(std::uint32_t block) const {
  if (!entries_[block].facts) return false;
  const std::vector<KnownFiner>& known = entries_[block].facts->finer;
  for (const std::uint32_t finer : graph_.dependents(block)) {
    if (finer >= entries_.size() || !entries_[finer].facts) continue;
    const KnownFiner now{BlockId{finer}, entries_[finer].facts->roots};
    if (std::find(known.begin(), known.end(), now) == known.end()) return true;
  }
  return false;
}

void LevelChoice::discard_lists(Entry& entry) {
  for (LevelListPtr& list : entry.lists) discard(list);
}

void LevelChoice::look_at(std::uint32_t block, const LevelFacts& facts) {
  const BlockBounds& own = graph_.own(block);
  LevelsLeft left(1);
  for (int k = 0; k < kFullLevel; ++k) {
    left.add(0, k, RoundedError::from(facts.left[static_cast<std::size_t>(k)]));
  }
  Looked& looked = looked_[block];
  looked = {};
  looked.whole = {own.center, own.bounds.radius};
  std::copy(left.off.begin(), left.off.end(), looked.off.begin());
  std::copy(left.degrees.begin(), left.degrees.end(), looked.degrees.begin());
  looked.pieces = facts.pieces;
  looked.first_inner = facts.first_inner;
  looked.left = {facts.left_in_piece.off.data(), facts.left_in_piece.degrees.data(),
                 facts.left_in_piece.count};
}

void LevelChoice::drop(std::uint32_t block) {
  if (block >= states_.size()) return;
  discard(entries_[block].facts);
  discard_lists(entries_[block]);
  entries_[block] = {};
  states_[block] = {};
  looked_[block] = {};
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
      discard(entry.lists[k]);
      state.lists = static_cast<std::uint16_t>(state.lists & ~(1u << k));
      resized_.push_back(block);
      any = true;
    }
  }
  return any;
}

// The level of the last choice stays while it is right and the next coarser one is not. Mostly that
// is told by the piece that was wrong the last time. The coarse end comes first: it may be right
// where levels above it are not, in which inner splits are undone.
int LevelChoice::wanted_level(std::uint32_t block, const View& view) {
  const State& state = states_[block];
  if (!state.can_choose) return kFullLevel;
  Looked& looked = looked_[block];
  const LeftAtLevels left{looked.off.data(), looked.degrees.data(), 1};
  const Seen whole(looked.whole, left, 0, view.error);
  const auto is_still_wrong = [&](std::uint32_t piece, int level, const auto& reaches) {
    return piece != kNone && whole.is_wrong(level, reaches) &&
           Seen(looked.pieces[piece], looked.left, piece, view.error).is_wrong(level, reaches);
  };
  const auto coarsest = [&](std::uint32_t& wrong, const auto& reaches, int level, int end) {
    return coarsest_right(looked, wrong, view.error, reaches, level,
                          whole.right_from(level, end, reaches));
  };
  const int before = state.chosen;
  const bool is_needed = before > 0 && is_still_wrong(looked.wrong_piece, before - 1, view.keep);
  // What is wrong at a level is so at the coarse end as well, unless it is inner.
  const bool is_above =
      is_needed && looked.wrong_piece < looked.first_inner && whole.is_wrong(0, view.keep);
  if (!is_above) {
    const ViewError::Reaches& reaches = before > 0 ? view.keep : view.at_all;
    std::uint32_t& wrong = looked.wrong_at_coarse_end;
    if (!is_still_wrong(wrong, 0, reaches) && coarsest(wrong, reaches, 0, 1) == 0) return 0;
  }
  if (before > 1 && !is_needed) {
    const int level = coarsest(looked.wrong_piece, view.keep, 1, before);
    if (level < before) return level;
  }
  return coarsest(looked.wrong_piece, view.at_all, std::max(before, 1), kFullLevel);
}

// The coarsest one from `level` to `end` at which no piece is wrong, or else the end. Finer levels
// are right where coarser ones are, but for the coarse end.
int LevelChoice::coarsest_right(const Looked& looked, std::uint32_t& wrong_piece,
                                const ViewError& error, const ViewError::Reaches& reaches,
                                int level, int end) {
  // What holds the piece that is looked at: where it ends, and the level that is right for it.
  struct Outer {
    std::size_t next;
    int level;
  };
  std::array<Outer, kMostHalvings + 2> outer{Outer{looked.pieces.size(), end}};
  std::size_t depth = 0;
  for (std::size_t i = 0; i < looked.pieces.size() && level < end;) {
    while (i >= outer[depth].next) --depth;
    const LevelSphere& piece = looked.pieces[i];
    const int right =
        Seen(piece, looked.left, i, error).right_from(level, outer[depth].level, reaches);
    const bool has_parts = piece.next > i + 1;
    if (right > level && has_parts) {
      outer[++depth] = {piece.next, right};
      ++i;
      continue;
    }
    if (right > level) wrong_piece = static_cast<std::uint32_t>(i);
    level = right;
    i = piece.next;
  }
  return level;
}

// What the choice of a block begins with. It lies apart for each block, and mostly far away.
void LevelChoice::fetch(std::uint32_t block) const {
  const State& state = states_[block];
  if (!state.can_choose || state.wanted == kFullLevel) return;
  const Looked& looked = looked_[block];
  const std::size_t at = state.wanted * looked.left.count;
  __builtin_prefetch(looked.pieces.data());
  if (looked.wrong_piece != kNone) __builtin_prefetch(&looked.pieces[looked.wrong_piece]);
  __builtin_prefetch(looked.left.off);
  __builtin_prefetch(looked.left.off + at);
  if (state.wanted > 0) __builtin_prefetch(looked.left.off + at - looked.left.count);
}

// It, or the next finer one that is there.
int LevelChoice::level_at_hand(const State& state, int level) {
  while (level > 0 && level < kFullLevel && (state.lists >> level & 1) == 0) ++level;
  return level;
}

// It, or the next coarser one that is there.
int LevelChoice::coarser_at_hand(const State& state, int level) {
  while (level > 0 && level < kFullLevel && (state.lists >> level & 1) == 0) --level;
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
  const View view{error, error.reaches(keep), error.reaches(1)};
  for (std::size_t i = cut.size(); i-- > 0;) {
    if (i >= kFetchedBefore) fetch(cut[i - kFetchedBefore]);
    const std::uint32_t block = cut[i];
    State& state = states_[block];
    const bool is_needed = state.needed_at == choices_;
    const int level = is_needed ? kFullLevel : wanted_level(block, view);
    state.wanted = static_cast<std::uint8_t>(level);
    state.chosen = is_needed || !state.can_choose ? std::uint8_t(0) : state.wanted;
    has_changed |= show(block, level_at_hand(state, level));
    if (state.shown == 0) continue;
    for (const std::uint32_t needed : graph_.dependencies(block)) {
      states_[needed].needed_at = choices_;
    }
  }
  return hide_others() || has_changed;
}

// Than its coarse end has.
std::int64_t LevelChoice::more_triangles(std::uint32_t block, int level) const {
  if (level == 0) return 0;
  if (level == kFullLevel) return graph_.more_triangles(block);
  return std::int64_t(triangles_at(block, level)) - graph_.entry(block).facts.triangles_coarse;
}

// What is at hand of the levels, and how many triangles that are.
template <typename AtHand>
std::int64_t LevelChoice::plan(std::span<const std::uint32_t> cut,
                               std::span<const std::uint8_t> levels, AtHand at_hand) {
  planned_.resize(cut.size());
  is_needed_.assign(states_.size(), 0);
  std::int64_t triangles = 0;
  for (std::size_t i = cut.size(); i-- > 0;) {
    const std::uint32_t block = cut[i];
    const int level = is_needed_[block] != 0 ? kFullLevel : at_hand(states_[block], levels[block]);
    planned_[i] = static_cast<std::uint8_t>(level);
    triangles += more_triangles(block, level);
    if (level == 0) continue;
    for (const std::uint32_t needed : graph_.dependencies(block)) is_needed_[needed] = 1;
  }
  return triangles;
}

// Those that nothing finer needs are the last ones.
std::int64_t LevelChoice::hide_finest(std::span<const std::uint32_t> cut, std::int64_t triangles,
                                      std::int64_t max_triangles) {
  for (std::size_t i = cut.size(); i-- > 0 && triangles > max_triangles;) {
    if (graph_.is_base(cut[i])) break;
    triangles -= more_triangles(cut[i], planned_[i]);
    planned_[i] = 0;
  }
  return triangles;
}

bool LevelChoice::show_at(std::span<const std::uint32_t> cut, std::span<const std::uint8_t> levels,
                          std::size_t max_triangles) {
  bool has_changed = begin_choice(cut);
  const auto most = static_cast<std::int64_t>(
      std::min<std::size_t>(max_triangles, std::numeric_limits<std::int64_t>::max()));
  if (plan(cut, levels, level_at_hand) > most) {
    hide_finest(cut, plan(cut, levels, coarser_at_hand), most);
  }
  for (std::size_t i = cut.size(); i-- > 0;) {
    State& state = states_[cut[i]];
    state.wanted = levels[cut[i]];
    state.chosen = 0;
    has_changed |= show(cut[i], planned_[i]);
  }
  return hide_others() || has_changed;
}

bool LevelChoice::choose_whole(std::span<const std::uint32_t> cut) {
  bool has_changed = begin_choice(cut);
  for (const std::uint32_t block : cut) {
    states_[block].wanted = kFullLevel;
    states_[block].chosen = 0;
    has_changed |= show(block, kFullLevel);
  }
  return hide_others() || has_changed;
}

bool LevelChoice::show(std::uint32_t block, int level) {
  State& state = states_[block];
  if (level > 0) is_shown_.push_back(block);
  const bool has_changed = state.shown != level;
  if (has_changed) change(block, level);
  state.seen_at = choices_;
  return has_changed;
}

void LevelChoice::change(std::uint32_t block, int level) {
  State& state = states_[block];
  Entry& entry = entries_[block];
  if (state.shown < kFullLevel) entry.shown_at[state.shown] = state.seen_at;
  state.shown = static_cast<std::uint8_t>(level);
  set_list(state, list_at(entry, level));
}

void LevelChoice::set_list(State& state, const LevelList* list) {
  state.list = list;
  state.revision = list != nullptr ? list->revision : 0;
}

const LevelList* LevelChoice::list_at(const Entry& entry, int level) {
  return level < kFullLevel ? entry.lists[std::size_t(level)].get() : nullptr;
}

// Those that the cut no longer goes through.
bool LevelChoice::hide_others() {
  bool any = false;
  for (const std::uint32_t block : was_shown_) {
    State& state = states_[block];
    if (state.seen_at == choices_ || state.shown == 0) continue;
    change(block, 0);
    state.wanted = state.chosen = 0;
    any = true;
  }
  return any;
}

// Of the pieces without parts the worst; none is worse than what holds it. With the eye inside of
// its sphere, something with parts says nothing of them.
float LevelChoice::error_at(std::uint32_t block, int level, const ViewError& error) const {
  const auto seen = [&error](const LevelSphere& sphere, RoundedUp off, RoundedUp degrees,
                             float least_radii) {
    SplitBounds bounds;
    bounds.surface = off;
    bounds.degrees = degrees;
    bounds.radius = sphere.radius;
    return error.of(bounds, sphere.center, least_radii);
  };
  const Looked& looked = looked_[block];
  struct Outer {
    std::size_t next;
    float error;
  };
  const auto k = static_cast<std::size_t>(level);
  const float of_whole = seen(looked.whole, looked.off[k], looked.degrees[k], 0);
  std::array<Outer, kMostHalvings + 2> outer{Outer{looked.pieces.size(), of_whole}};
  std::size_t depth = 0;
  float most = 0;
  for (std::size_t i = 0; i < looked.pieces.size();) {
    while (i >= outer[depth].next) --depth;
    const LevelSphere& piece = looked.pieces[i];
    const bool has_parts = piece.next > i + 1;
    const std::size_t at = k * looked.left.count + i;
    const float own = std::min(
        outer[depth].error,
        seen(piece, looked.left.off[at], looked.left.degrees[at], has_parts ? 0 : kNearestRadii));
    if (has_parts && own > most) {
      outer[++depth] = {piece.next, own};
      ++i;
      continue;
    }
    if (!has_parts) most = std::max(most, own);
    i = piece.next;
  }
  return most;
}

LevelError LevelChoice::left(std::uint32_t block, const LevelError& coarse) const {
  const int level = shown(block);
  if (level == kFullLevel) return {};
  if (block >= states_.size() || !states_[block].can_choose) return coarse;
  return entries_[block].facts->left[std::size_t(level)];
}

std::vector<ErrorSphere> LevelChoice::errors(std::uint32_t block, int level) const {
  std::vector<ErrorSphere> errors;
  if (level == kFullLevel) return errors;
  const LevelFactsPtr known = facts(block);
  if (!known || known->pieces.empty()) {
    const BlockBounds& own = graph_.own(block);
    const RoundedUp off = worse(own.bounds.surface, own.bounds.line);
    errors.push_back({own.center, own.bounds.radius.value(), off.value()});
    return errors;
  }
  const LevelsLeft& left = known->left_in_piece;
  for (std::size_t i = 0; i < known->pieces.size(); ++i) {
    const LevelSphere& piece = known->pieces[i];
    const float off = left.off[static_cast<std::size_t>(level) * left.count + i].value();
    const bool has_parts = piece.next > i + 1;
    if (!has_parts && off > 0) errors.push_back({piece.center, piece.radius.value(), off});
  }
  return errors;
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
             sizeof(KnownFiner) * entry.facts->finer.capacity() +
             sizeof(LevelSphere) * entry.facts->pieces.capacity() +
             sizeof(RoundedUp) * (entry.facts->left_in_piece.off.capacity() +
                                  entry.facts->left_in_piece.degrees.capacity());
  }
  for (const LevelListPtr& list : entry.lists) bytes += list ? list->bytes() : 0;
  return bytes;
}

}  // namespace crease
