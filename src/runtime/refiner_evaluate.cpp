// What is watched, and what is found.
#include "hierarchy/grid_sum.h"
#include "runtime/refiner.h"

#include <algorithm>
#include <bit>

namespace crease {

namespace {

constexpr int kFramesOnOdometer = 4096;  // so that floats can tell what a frame adds
constexpr float kFar = 1e15f;
constexpr double kOfBefore = 0.75;  // what a frame before this one tells of those to come

}  // namespace

void Refiner::look_from(const ActiveCut& cut, const ViewParameters& view) {
  ViewParameters moved = view_;
  moved.camera.position = view.camera.position;
  moved.camera.target = view.camera.target;
  moved.camera.up = view.camera.up;
  moved.clock = view.clock;
  moved.clock_context = view.clock_context;
  moved.max_seconds = view.max_seconds;
  moved.max_triangles = view.max_triangles;
  bool only_moved = has_view_ && moved == view;
  has_view_ = true;
  view_ = view;
  const ViewError before = error_;
  error_ = ViewError(view, cut.hierarchy().vertices.grid);
  const ViewError::Motion motion = error_.motion_from(before);
  odometer_.travel += motion.travel;
  odometer_.turn += motion.turn;
  late_.travel = kOfBefore * late_.travel + motion.travel;
  late_.turn = kOfBefore * late_.turn + motion.turn;
  // Of distances whose squares no float holds no answer is kept.
  const bool is_far = !(error_.eye_length() < kFar);
  if (is_far || was_far_) {
    only_moved = false;
    late_ = {};
  }
  was_far_ = is_far;
  odometer_.turn_per_travel = Odometer::ratio(late_.turn, late_.travel);
  odometer_.slop = 1e-6f * error_.eye_length();
  if (!only_moved || ++frames_on_odometer_ > kFramesOnOdometer) {
    odometer_.travel = odometer_.turn = 0;
    frames_on_odometer_ = 0;
    wrong_.look_at_all();
    merged_.look_at_all();
  }
  merge_below_ = static_cast<float>(1 / std::max(1.0, view.hysteresis));
  is_ordered_ =
      view.clock != nullptr || view.max_triangles != std::numeric_limits<std::size_t>::max();
  counts_all_merges_ = false;
  splits_.clear();
  merges_.clear();
  if (!only_moved) watch_all(cut);
}

void Refiner::watch_all(const ActiveCut& cut) {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  wrong_ = {};
  merged_ = {};
  wrong_.resize(cut.vertices().size(), error_.uses_cones());
  pairs_.clear();
  pair_of_slot_.assign(cut.vertices().size(), kNone);
  for (std::uint32_t slot = 0; slot < cut.vertices().size(); ++slot) {
    const ActiveVertex& v = cut.vertices()[slot];
    if (v.node == kNoNode) continue;
    watch_vertex(cut, slot);
    if (h.is_root(v.node)) continue;
    const SplitId above = h.split_above(v.node);
    if (!cut.can_merge(above)) continue;
    if (h.is_second(v.node) && cut.children(above).first != kNoSlot) continue;
    watch_pair(slot, above, watch_above(cut, v, above));
  }
}

void Refiner::watch_vertex(const ActiveCut& cut, std::uint32_t slot) {
  const ActiveVertex& v = cut.vertices()[slot];
  if (v.split == kNoSplit) return wrong_.turn_off(slot);
  const SplitBounds& bounds = bounds_of(cut, v.split);
  wrong_.set<true>(slot, error_.watch(bounds, error_.position(v.position), 1), error_, odometer_);
}

void Refiner::watch_pair(std::uint32_t slot, SplitId s, const Watch& watch) {
  std::uint32_t& pair = pair_of_slot_[slot];
  if (pair == kNone) {
    pair = static_cast<std::uint32_t>(pairs_.size());
    pairs_.push_back({});
    merged_.grow(pairs_.size(), error_.uses_cones());
  }
  pairs_[pair] = {s, slot};
  merged_.set<false>(pair, watch, error_, odometer_);
}

void Refiner::drop_pair(std::uint32_t slot) {
  const std::uint32_t pair = pair_of_slot_[slot];
  if (pair == kNone) return;
  pair_of_slot_[slot] = kNone;
  const std::size_t last = pairs_.size() - 1;
  if (pair != last) {
    merged_.set_as(pair, last);
    pairs_[pair] = pairs_[last];
    pair_of_slot_[pairs_[pair].slot] = pair;
  }
  pairs_.pop_back();
  merged_.shrink(last);
}

// Of the parent of v, as something that is to be merged.
Watch Refiner::watch_above(const ActiveCut& cut, const ActiveVertex& v, SplitId above) const {
  if (is_required(above)) return kAlwaysWrong;
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const Vec3i position = grid_difference(v.position, h.delta_of(v.node));
  return error_.watch(bounds_of(cut, above), error_.position(position), merge_below_);
}

float Refiner::excess_above(const ActiveCut& cut, const ActiveVertex& v, SplitId above) const {
  const VertexHierarchy& h = cut.hierarchy().vertices;
  const Vec3i position = grid_difference(v.position, h.delta_of(v.node));
  return error_.of(bounds_of(cut, above), error_.position(position));
}

void Refiner::find_merges(const ActiveCut& cut) {
  report_.evaluated += merged_.find<false>(
      error_, odometer_,
      [&](std::uint32_t pair) { wish_merge(cut, pairs_[pair].split, pairs_[pair].slot); },
      at_once_);
  if (!is_ordered_) sort_by_place(cut, merges_.wishes);
}

void Refiner::find_splits(const ActiveCut& cut) {
  if (is_ordered_) {
    report_.evaluated += wrong_.find<true>(
        error_, odometer_, [&](std::uint32_t slot) { wish_split(cut, slot); }, at_once_);
    return;
  }
  // What the vertices say is read when all are found, with the memory of the next ones on its way.
  std::vector<Wish>& wishes = splits_.wishes;
  const std::size_t known = wishes.size();  // what was split for others has found some already
  report_.evaluated += wrong_.find<true>(
      error_, odometer_,
      [&](std::uint32_t slot) {
        wishes.push_back({0, kNoSplit, slot});
      },
      at_once_);
  const std::span<const ActiveVertex> vertices = cut.vertices();
  for (std::size_t i = known; i < wishes.size(); ++i) {
    if (i + 12 < wishes.size()) __builtin_prefetch(&vertices[wishes[i + 12].slot]);
    wishes[i].split = vertices[wishes[i].slot].split;
  }
  sort_by_place(cut, wishes);
}

// Into as many ranges of wedges as there are wishes, about. What is found on the way (split(),
// merge()) comes in the same order.
void Refiner::sort_by_place(const ActiveCut& cut, std::vector<Wish>& wishes) {
  constexpr unsigned kMostBits = 12;
  const unsigned bits = bits_for(cut.hierarchy().vertices.wedge_count());
  const unsigned range_bits =
      std::min({bits, kMostBits, static_cast<unsigned>(std::bit_width(wishes.size()))});
  const auto range_of = [&](const Wish& wish) {
    return index_of(cut.vertices()[wish.slot].begin) >> (bits - range_bits);
  };
  first_in_range_.assign((std::size_t(1) << range_bits) + 1, 0);
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    if (i + 12 < wishes.size()) __builtin_prefetch(&cut.vertices()[wishes[i + 12].slot]);
    ++first_in_range_[range_of(wishes[i]) + 1];
  }
  for (std::size_t i = 1; i < first_in_range_.size(); ++i) {
    first_in_range_[i] += first_in_range_[i - 1];
  }
  sorted_.resize(wishes.size());
  for (const Wish& wish : wishes) sorted_[first_in_range_[range_of(wish)]++] = wish;
  wishes.swap(sorted_);
}

void Refiner::wish_split(const ActiveCut& cut, std::uint32_t slot) {
  const ActiveVertex& v = cut.vertices()[slot];
  std::vector<Wish>& wishes = splits_.wishes;
  wishes.push_back({0, v.split, slot});
  if (!is_ordered_) return;
  const SplitBounds& bounds = bounds_of(cut, v.split);
  wishes.back().excess = error_.of(bounds, error_.position(v.position));
  std::push_heap(wishes.begin(), wishes.end(),
                 [](const Wish& a, const Wish& b) { return a.excess < b.excess; });
}

void Refiner::wish_merge(const ActiveCut& cut, SplitId s, std::uint32_t slot) {
  std::vector<Wish>& wishes = merges_.wishes;
  wishes.push_back({0, s, slot});
  if (!is_ordered_) return;
  wishes.back().excess = excess_above(cut, cut.vertices()[slot], s);
  std::push_heap(wishes.begin(), wishes.end(),
                 [](const Wish& a, const Wish& b) { return a.excess > b.excess; });
}

}  // namespace crease
