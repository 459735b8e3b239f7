// Which splits and merges a view needs, in which order, within budgets.
//
// A frame asks two questions, each in one pass over memory (WatchList): which active vertices are
// seen to be wrong, and which pairs of siblings stand for one that is not. Between the passes and
// after them only what moved is looked at. A pair is watched by the slot of one of its vertices,
// the one that came to be a leaf of the cut last, until it merges or that vertex is split; where
// the other one has been split meanwhile, the answer is of no use and the watch is dropped then.
//
// Without a budget the cut that is reached does not depend on the order. So moves are done in about
// the order of wedges, which follow the tree and the curve of its roots: neighbours share vertices,
// triangles and what the hierarchy says of them. And they are done at once: first all vertices are
// merged, or split, and only what is not to be moved again is watched; then corners follow
// (ActiveCut). With a budget heaps order moves, splits by what is most visible, merges by what is
// least, and each is done by itself.
//
// Memory: a watch per slot and per pair, 4 bytes a slot and 8 a pair.
#pragma once

#include "crease/adaptive_mesh.h"
#include "runtime/active_cut.h"
#include "runtime/geomorphs.h"
#include "runtime/watch_list.h"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace crease {

class Refiner {
 public:
  // It tells `geomorphs`, if there are, of its moves, and lets merges wait for them.
  explicit Refiner(Geomorphs* geomorphs = nullptr) : geomorphs_(geomorphs) {}

  // In place of the hierarchy's, per split. They may change if look_anew() says so.
  void use_bounds(std::span<const SplitBounds> bounds) { bounds_ = bounds; }
  void look_anew() { has_view_ = false; }

  UpdateReport update(ActiveCut& cut, const ViewParameters& view);
  UpdateReport set_error(ActiveCut& cut, float error);

  // These vertices, whatever the view says, as far as there are at most `max_triangles` then. How
  // many were; the next update() looks at all anew.
  std::size_t split_vertices(ActiveCut& cut, std::span<const std::uint32_t> slots,
                             std::size_t max_triangles);

  // Whatever the view says, what has a number here is split, on the way to leaves that must be
  // active. Per split; the caller's. Not with a budget.
  void use_required(std::span<const std::uint8_t> required) { required_ = required; }
  // Each change of it is told before the next update(): that a leaf, whose first wedge this is,
  // must be active; that a number is no longer 0; that it is 0 again.
  void require(WedgeId wedge, NodeId leaf) {
    required_leaves_.push_back({wedge, leaf});
    requires_anew_ = true;
  }
  void hold(const ActiveCut& cut, SplitId s);
  void release(const ActiveCut& cut, SplitId s);

  // How much farther the camera may travel, and turn, before update() finds something to do.
  WatchList::Slack slack() const;

  std::size_t bytes() const {
    return wrong_.bytes() + merged_.bytes() + 4 * pair_of_slot_.capacity() +
           sizeof(Pair) * pairs_.capacity() +
           sizeof(Wish) * (splits_.capacity() + merges_.capacity() + sorted_.capacity()) +
           4 * first_in_range_.capacity() + sizeof(Required) * required_leaves_.capacity();
  }

 private:
  struct Required {
    WedgeId wedge{};
    NodeId leaf = kNoNode;
  };
  struct Wish {
    float excess;  // of what is to be split, or merged; 0 where the order is of no consequence
    SplitId split;
    std::uint32_t slot;  // of its vertex, or for merges of the one that watches
  };
  // More visible than anything.
  static constexpr Wish kMostVisible{std::numeric_limits<float>::infinity(), kNoSplit, kNoSlot};
  // Moves to be done, first come first served, or a heap.
  struct Queue {
    std::vector<Wish> wishes;
    std::size_t next = 0;

    bool empty() const { return next == wishes.size(); }
    void clear() {
      wishes.clear();
      next = 0;
    }
    std::size_t capacity() const { return wishes.capacity(); }
  };
  struct Pair {
    SplitId split;
    std::uint32_t slot;
  };

  const SplitBounds& bounds_of(const ActiveCut& cut, SplitId s) const {
    return bounds_.empty() ? cut.hierarchy().vertices.bounds[index_of(s)] : bounds_[index_of(s)];
  }
  void look_from(const ActiveCut& cut, const ViewParameters& view);
  void watch_all(const ActiveCut& cut);
  void watch_vertex(const ActiveCut& cut, std::uint32_t slot);
  bool watch_child(const ActiveCut& cut, std::uint32_t slot);
  void watch_pair(std::uint32_t slot, SplitId s, const Watch& watch);
  void drop_pair(std::uint32_t slot);
  Watch watch_above(const ActiveCut& cut, const ActiveVertex& v, SplitId above) const;
  void find_merges(const ActiveCut& cut);
  void find_splits(const ActiveCut& cut);
  void sort_by_place(const ActiveCut& cut, std::vector<Wish>& wishes);
  void wish_split(const ActiveCut& cut, std::uint32_t slot);
  void wish_merge(const ActiveCut& cut, SplitId s, std::uint32_t slot);
  float excess_above(const ActiveCut& cut, const ActiveVertex& v, SplitId above) const;

  template <typename Later>
  Wish take(Queue& queue, Later later) const;
  void count_merge(const ActiveCut& cut, SplitId s, std::uint32_t slot);
  void fetch_merges(const ActiveCut& cut) const;
  void fetch_splits(const ActiveCut& cut) const;
  bool out_of_time();
  void do_merges(ActiveCut& cut);
  void do_splits(ActiveCut& cut);
  void count_all_merges(const ActiveCut& cut);
  void keep_to_budget(ActiveCut& cut, const Wish& wanted, std::size_t room);
  bool merge_for_room(ActiveCut& cut, const Wish& wanted, std::size_t room);
  void split(ActiveCut& cut, std::uint32_t slot);
  std::uint32_t move_down(ActiveCut& cut, std::uint32_t slot);
  void move_up(ActiveCut& cut, SplitId s, const ActiveCut::Children& children);
  bool waits(const ActiveCut& cut, SplitId s, const ActiveCut::Children& children, bool for_room);
  bool has_geomorphs() const {
    return geomorphs_ != nullptr && (geomorphs_->is_on() || geomorphs_->moving_count() > 0);
  }
  void turn_back(const ActiveCut& cut);
  bool merge_arrived(ActiveCut& cut);  // true if some had
  std::size_t leaving_triangles() const {
    return geomorphs_ == nullptr ? 0 : geomorphs_->leaving_triangles();
  }
  void split_consistently(ActiveCut& cut, std::uint32_t slot);
  void merge(ActiveCut& cut, SplitId s, const ActiveCut::Children& children);
  bool needs_split(const ActiveCut& cut, SplitId s, std::uint32_t& third) const;
  bool is_needed(const ActiveCut& cut, SplitId s) const;
  void split_required(ActiveCut& cut);
  bool is_required(SplitId s) const { return !required_.empty() && required_[index_of(s)] != 0; }

  Geomorphs* geomorphs_;
  std::span<const SplitBounds> bounds_;  // or empty: the hierarchy's
  ViewParameters view_;
  ViewError error_;
  bool has_view_ = false;
  bool is_ordered_ = false;
  bool at_once_ = false;  // all that is found to be due is done by this update()
  float merge_below_ = 1;
  Odometer odometer_;
  bool was_far_ = false;
  ViewError::Motion late_{};  // of the last frames, each less than the one after it
  int frames_on_odometer_ = 0;
  WatchList wrong_;                          // per slot
  WatchList merged_;                         // per pair
  std::vector<Pair> pairs_;                  // in no order
  std::vector<std::uint32_t> pair_of_slot_;  // or kNone
  Queue splits_, merges_;
  std::vector<Wish> sorted_, waiting_;         // scratch
  std::vector<std::uint32_t> first_in_range_;  // scratch
  bool finds_splits_ = false;                  // still to be done for this view
  std::span<const std::uint8_t> required_;     // per split; or empty: none is
  std::vector<Required> required_leaves_;      // new ones
  bool requires_anew_ = false;
  std::vector<Wish>
      least_visible_;  // a heap of every possible merge, while a triangle budget binds
  bool counts_all_merges_ = false;
  std::vector<std::uint32_t> pending_;
  UpdateReport report_;
  double stop_at_ = 0;
  std::uint32_t moves_until_clock_ = 0;
};

}  // namespace crease
