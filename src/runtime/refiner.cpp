// The order of work. What is due is found in refiner_evaluate.cpp.
#include "runtime/refiner.h"

#include "base/assert.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace crease {

namespace {

constexpr std::uint32_t kMovesPerClock = 64;

}  // namespace

template <typename Later>
Refiner::Wish Refiner::take(Queue& queue, Later later) const {
  if (!is_ordered_) return queue.wishes[queue.next++];
  std::vector<Wish>& wishes = queue.wishes;
  const Wish wish = wishes.front();
  std::pop_heap(wishes.begin(), wishes.end(), later);
  wishes.pop_back();
  return wish;
}

UpdateReport Refiner::update(ActiveCut& cut, const ViewParameters& view) {
  report_ = {};
  const bool looks_anew = !has_view_ || !(view == view_);
  if (looks_anew) {
    look_from(cut, view);
    turn_back(cut);
  }
  at_once_ = !is_ordered_ && !view.consistent && !has_geomorphs();
  const bool requires_anew = std::exchange(requires_anew_, false);
  if (looks_anew || requires_anew) {
    splits_.clear();
    merges_.clear();
    find_merges(cut);
    finds_splits_ = true;
  }
  stop_at_ = view.clock == nullptr ? std::numeric_limits<double>::infinity()
                                   : view.clock(view.clock_context) + view.max_seconds;
  moves_until_clock_ = 0;
  // What was needed by one that has gone, or was about to go, may be merged now.
  if (merge_arrived(cut) && view_.consistent) counts_all_merges_ = false;
  if (cut.triangle_count() > view_.max_triangles) {
    keep_to_budget(cut, kMostVisible, 0);
  }
  do_merges(cut);
  if (requires_anew) split_required(cut);
  if (finds_splits_ && merges_.empty()) {
    find_splits(cut);
    finds_splits_ = false;
  }
  do_splits(cut);
  return report_;
}

// Done from the top down and from the bottom up; nothing is queued.
UpdateReport Refiner::set_error(ActiveCut& cut, float error) {
  report_ = {};
  at_once_ = false;
  has_view_ = false;
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const auto is_coarse = [&](SplitId s) {
    const SplitBounds& bounds = bounds_of(cut, s);
    return std::max(bounds.surface.value(), bounds.line.value()) > error || error < 0;
  };
  if (geomorphs_ != nullptr) {
    for (const Geomorphs::Leaving& l : geomorphs_->all_leaving()) {
      if (is_coarse(l.split)) {
        geomorphs_->stay(cut, l.split);
      } else if (l.has_arrived && cut.can_merge(l.split)) {
        move_up(cut, l.split, cut.children(l.split));
      }
    }
  }
  for (std::uint32_t slot = 0; slot < cut.vertices().size(); ++slot) pending_.push_back(slot);
  while (!pending_.empty()) {
    const std::uint32_t slot = pending_.back();
    pending_.pop_back();
    const NodeId node = cut.vertices()[slot].node;
    if (node == kNoNode) continue;
    if (const SplitId s = cut.vertices()[slot].split; s != kNoSplit && is_coarse(s)) {
      const std::uint32_t other = move_down(cut, slot);
      if (other != kNoSlot) pending_.push_back(other);
      pending_.push_back(slot);
      continue;
    }
    if (h.is_root(node)) continue;
    const SplitId above = h.split_above(node);
    if (is_coarse(above) || !cut.can_merge(above)) continue;
    const ActiveCut::Children children = cut.children(above);
    if (waits(cut, above, children, false)) continue;
    move_up(cut, above, children);
    pending_.push_back(children.first != kNoSlot ? children.first : children.second);
  }
  return report_;
}

std::size_t Refiner::split_vertices(ActiveCut& cut, std::span<const std::uint32_t> slots,
                                    std::size_t max_triangles) {
  report_ = {};
  at_once_ = false;
  has_view_ = false;
  for (const std::uint32_t slot : slots) {
    const SplitId s = cut.vertices()[slot].split;
    const std::size_t gain = cut.hierarchy().vertices.triangles_of(s).size();
    if (cut.triangle_count() + gain <= max_triangles) move_down(cut, slot);
  }
  return report_.splits;
}

bool Refiner::out_of_time() {
  if (view_.clock == nullptr) return false;
  if (moves_until_clock_ > 0) {
    --moves_until_clock_;
    return false;
  }
  if (view_.clock(view_.clock_context) >= stop_at_) {
    report_.complete = false;
    return true;
  }
  moves_until_clock_ = kMovesPerClock;
  return false;
}

// Of moves to come. To follow them further, to third vertices, took as long as it saved.
void Refiner::fetch_merges(const ActiveCut& cut) const {
  const std::vector<Wish>& wishes = merges_.wishes;
  const std::size_t i = merges_.next, count = wishes.size();
  if (i + 12 < count) {
    cut.prefetch_merge(wishes[i + 12].slot, wishes[i + 12].split);
    __builtin_prefetch(&pair_of_slot_[wishes[i + 12].slot]);
  }
  if (i + 8 < count) {
    cut.prefetch_merge_further(wishes[i + 8].split);
    const std::uint32_t slot = wishes[i + 8].slot;
    wrong_.prefetch(slot);
    if (pair_of_slot_[slot] != kNone) merged_.prefetch(pair_of_slot_[slot]);
  }
  if (i + 6 < count) cut.prefetch_begins(wishes[i + 6].split);
  if (i + 4 < count) {
    const ActiveCut::Children children = cut.prefetch_children(wishes[i + 4].split);
    if (children.first != kNoSlot) __builtin_prefetch(pair_of_slot_.data() + children.first);
    if (children.second != kNoSlot) __builtin_prefetch(pair_of_slot_.data() + children.second);
  }
}

void Refiner::fetch_splits(const ActiveCut& cut) const {
  const std::vector<Wish>& wishes = splits_.wishes;
  const std::size_t i = splits_.next, count = wishes.size();
  if (i + 8 < count) {
    const std::uint32_t slot = wishes[i + 8].slot, other = cut.slot_to_come(8);
    cut.prefetch_split(slot, wishes[i + 8].split);
    wrong_.prefetch(slot);
    __builtin_prefetch(pair_of_slot_.data() + slot);
    if (other != kNoSlot) {
      wrong_.prefetch(other);
      __builtin_prefetch(pair_of_slot_.data() + other);
      __builtin_prefetch(&cut.vertices()[other]);
    }
  }
  if (i + 4 < count) cut.prefetch_split_further(wishes[i + 4].split);
}

void Refiner::do_merges(ActiveCut& cut) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  while (!merges_.empty() && !out_of_time()) {
    if (!is_ordered_) fetch_merges(cut);
    const Wish wish =
        take(merges_, [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
    const NodeId node = cut.vertices()[wish.slot].node;
    if (node == kNoNode || h.is_root(node) || h.split_above(node) != wish.split) continue;
    const ActiveCut::Children children = cut.children(wish.split);
    const bool has_both = children.first != kNoSlot && children.second != kNoSlot;
    if (!has_both && !cut.can_merge(wish.split)) {
      drop_pair(wish.slot);
    } else if (is_required(wish.split)) {
      watch_pair(wish.slot, wish.split, kAlwaysWrong);
    } else if (!is_needed(cut, wish.split) && !waits(cut, wish.split, children, false)) {
      merge(cut, wish.split, children);
    }
  }
  if (merges_.empty()) merges_.clear();
  if (at_once_) cut.bring_corners_up();
}

void Refiner::do_splits(ActiveCut& cut) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const auto less_visible = [](const Wish& a, const Wish& b) { return a.excess < b.excess; };
  // Wishes for which others are leaving, and the triangles that these will have. More leave for the
  // next ones meanwhile.
  waiting_.clear();
  std::size_t reserved = 0;
  while (!splits_.empty() && !out_of_time()) {
    if (is_ordered_) {
      const Wish wish = splits_.wishes.front();
      if (cut.vertices()[wish.slot].split == wish.split) {
        const std::size_t room = reserved + h.triangles_of(wish.split).size();
        if (cut.triangle_count() + room > view_.max_triangles) {
          keep_to_budget(cut, wish, room);
          if (cut.triangle_count() + room > view_.max_triangles) {
            if (leaving_triangles() > 0) {
              report_.complete = false;  // there will be room
            } else if (report_.complete) {
              splits_.clear();  // nothing is less visible: this is it
            }
            if (cut.triangle_count() + room > view_.max_triangles + leaving_triangles()) break;
            waiting_.push_back(take(splits_, less_visible));
            reserved = room;
            continue;
          }
        }
      }
    }
    if (!is_ordered_) fetch_splits(cut);
    const Wish wish = take(splits_, less_visible);
    if (cut.vertices()[wish.slot].split != wish.split) continue;
    view_.consistent ? split_consistently(cut, wish.slot) : split(cut, wish.slot);
    if (is_ordered_ && cut.triangle_count() > view_.max_triangles) {
      // By what it depends on, of which nobody knew how many triangles it has.
      keep_to_budget(cut, kMostVisible, 0);
      splits_.clear();
      return;
    }
  }
  for (const Wish& wish : waiting_) {
    splits_.wishes.push_back(wish);
    std::push_heap(splits_.wishes.begin(), splits_.wishes.end(), less_visible);
  }
  if (splits_.empty()) splits_.clear();
  if (at_once_) cut.bring_corners_down();
}

void Refiner::count_all_merges(const ActiveCut& cut) {
  counts_all_merges_ = true;
  least_visible_.clear();
  for (const Pair& pair : pairs_) {
    const float excess = excess_above(cut, cut.vertices()[pair.slot], pair.split);
    least_visible_.push_back({excess, pair.split, pair.slot});
  }
  std::make_heap(least_visible_.begin(), least_visible_.end(),
                 [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
}

// Merges what is less visible than `wanted`, least visible first, until there is room. In
// consistent mode what was needed when its turn came is looked at again once others have merged.
void Refiner::keep_to_budget(ActiveCut& cut, const Wish& wanted, std::size_t room) {
  if (!counts_all_merges_) count_all_merges(cut);
  while (merge_for_room(cut, wanted, room) && view_.consistent) count_all_merges(cut);
}

// True if there is none yet though something has merged.
bool Refiner::merge_for_room(ActiveCut& cut, const Wish& wanted, std::size_t room) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const std::size_t merges_before = report_.merges;
  // Rounding may find a vertex less visible than its child; to merge it would not help the child.
  SplitId above = kNoSplit;
  if (wanted.split != kNoSplit) {
    const NodeId node = h.node_of_split[index_of(wanted.split)];
    if (!h.is_root(node)) above = h.split_above(node);
  }
  const auto is_full = [&] {
    return cut.triangle_count() - leaving_triangles() + room > view_.max_triangles;
  };
  while (!least_visible_.empty() && is_full()) {
    const Wish wish = least_visible_.front();
    const bool is_least = wish.excess < wanted.excess * merge_below_;
    if (!is_least || out_of_time()) return false;
    std::pop_heap(least_visible_.begin(), least_visible_.end(),
                  [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
    least_visible_.pop_back();
    if (wish.split == above) continue;
    if (!cut.can_merge(wish.split) || is_needed(cut, wish.split)) continue;
    const ActiveCut::Children children = cut.children(wish.split);
    if (!waits(cut, wish.split, children, true)) merge(cut, wish.split, children);
  }
  return is_full() && report_.merges > merges_before;
}

// What is below something that is wrong may be as wrong, and nothing of it is to be merged.
void Refiner::split(ActiveCut& cut, std::uint32_t slot) {
  const SplitId s = cut.vertices()[slot].split;
  const Vec3f position = error_.position(cut.vertices()[slot].position);
  const std::uint32_t other = move_down(cut, slot);
  if (cut.vertices().size() > pair_of_slot_.size()) {
    pair_of_slot_.resize(cut.vertices().size(), kNone);
    wrong_.resize(cut.vertices().size(), error_.uses_cones());
  }
  // What is to be split at once is watched when that is done.
  const bool splits_slot = watch_child(cut, slot);
  const bool splits_other = other != kNoSlot && watch_child(cut, other);
  if (!at_once_ || !(splits_slot || splits_other)) {
    watch_pair(
        slot, s,
        is_required(s) ? kAlwaysWrong : error_.watch(bounds_of(cut, s), position, merge_below_));
  } else if (!splits_slot) {
    drop_pair(slot);
  }
  if (counts_all_merges_) count_merge(cut, s, slot);
}

// Of a split. Whether it is to be split as well.
bool Refiner::watch_child(const ActiveCut& cut, std::uint32_t slot) {
  const ActiveVertex& v = cut.vertices()[slot];
  if (v.split == kNoSplit) {
    wrong_.turn_off(slot);
    return false;
  }
  const Watch watch = error_.watch(bounds_of(cut, v.split), error_.position(v.position), 1);
  const bool is_wrong = error_.is_wrong(watch);
  if (!is_wrong) {
    wrong_.set<true>(slot, watch, error_, odometer_);
  } else if (!at_once_) {
    wrong_.set(slot, watch);
  }
  if (is_wrong) wish_split(cut, slot);
  return is_wrong;
}

void Refiner::merge(ActiveCut& cut, SplitId s, const ActiveCut::Children& children) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  move_up(cut, s, children);
  if (children.first != kNoSlot && children.second != kNoSlot) {
    drop_pair(children.second);
    wrong_.turn_off(children.second);
  }
  const std::uint32_t slot = children.first != kNoSlot ? children.first : children.second;
  if (slot == kNoSlot) return;
  drop_pair(slot);
  const ActiveVertex& v = cut.vertices()[slot];
  if (!h.is_root(v.node)) {
    const SplitId above = h.split_above(v.node);
    if (cut.is_cut_leaf(h.child(above, !h.is_second(v.node)))) {  // its sibling
      const Watch watch = watch_above(cut, v, above);
      const bool merges_above = !error_.is_wrong(watch);
      if (merges_above) wish_merge(cut, above, slot);
      if (merges_above && at_once_) return;  // watched when that is done
      watch_pair(slot, above, watch);
      if (counts_all_merges_) count_merge(cut, above, slot);
    }
  }
  watch_vertex(cut, slot);
  if (counts_all_merges_ && error_.is_wrong(wrong_.get(slot))) wish_split(cut, slot);
}

void Refiner::count_merge(const ActiveCut& cut, SplitId s, std::uint32_t slot) {
  least_visible_.push_back({excess_above(cut, cut.vertices()[slot], s), s, slot});
  std::push_heap(least_visible_.begin(), least_visible_.end(),
                 [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
}

// A third vertex of what s brings whose own error is larger.
bool Refiner::needs_split(const ActiveCut& cut, SplitId s, std::uint32_t& third) const {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const float error = bounds_of(cut, s).surface.value();
  const TriangleRange born = h.triangles_of(s);
  for (std::uint32_t t = born.begin; t < born.end; ++t) {
    for (const WedgeId wedge : h.triangles[t]) {
      third = cut.slot_at(wedge);
      const SplitId other = cut.vertices()[third].split;
      if (other == kNoSplit || other == s) continue;
      if (bounds_of(cut, other).surface.value() > error) return true;
    }
  }
  return false;
}

void Refiner::split_consistently(ActiveCut& cut, std::uint32_t slot) {
  pending_.assign(1, slot);
  while (!pending_.empty()) {
    std::uint32_t third = kNoSlot;
    const std::uint32_t top = pending_.back();
    const SplitId s = cut.vertices()[top].split;
    CREASE_ASSERT(s != kNoSplit);
    if (needs_split(cut, s, third)) {
      pending_.push_back(third);
    } else {
      pending_.pop_back();
      split(cut, top);
    }
  }
}

// Its watchers need not look any more.
void Refiner::hold(const ActiveCut& cut, SplitId s) {
  if (!has_view_ || !cut.can_merge(s)) return;
  const ActiveCut::Children children = cut.children(s);
  for (const std::uint32_t slot : {children.first, children.second}) {
    const std::uint32_t pair = slot < pair_of_slot_.size() ? pair_of_slot_[slot] : kNone;
    if (pair != kNone && pairs_[pair].split == s) merged_.set(pair, kAlwaysWrong);
  }
}

void Refiner::release(const ActiveCut& cut, SplitId s) {
  requires_anew_ = true;
  if (!has_view_ || !cut.can_merge(s)) return;
  const ActiveCut::Children children = cut.children(s);
  const std::uint32_t slot = children.first != kNoSlot ? children.first : children.second;
  if (slot != kNoSlot) watch_pair(slot, s, watch_above(cut, cut.vertices()[slot], s));
}

void Refiner::split_required(ActiveCut& cut) {
  for (const Required& required : required_leaves_) {
    for (;;) {
      const std::uint32_t slot = cut.slot_at(required.wedge);
      if (cut.vertices()[slot].node == required.leaf) break;
      split(cut, slot);
    }
  }
  required_leaves_.clear();
}

WatchList::Slack Refiner::slack() const {
  if (!splits_.empty() || !merges_.empty()) return {-kNever, -kNever};
  const WatchList::Slack a = wrong_.slack(odometer_), b = merged_.slack(odometer_);
  return {std::min(a.travel, b.travel), std::min(a.turn, b.turn)};
}

// Required, or in consistent mode: something that is split has a third vertex below s, and a
// smaller error than s.
bool Refiner::is_needed(const ActiveCut& cut, SplitId s) const {
  if (is_required(s)) return true;
  if (!view_.consistent) return false;
  const float error = bounds_of(cut, s).surface.value();
  const ActiveCut::Children children = cut.children(s);
  for (const std::uint32_t slot : {children.first, children.second}) {
    if (slot == kNoSlot) continue;
    for (const CornerAt at : cut.corners_of(slot)) {
      const TriangleId t = cut.parts()[at.corner.part()].ids[at.corner.triangle()];
      const SplitId by = cut.introducing_split(t);
      if (by == kNoSplit || by == s) continue;
      if (bounds_of(cut, by).surface.value() < error) return true;
    }
  }
  return false;
}

}  // namespace crease
