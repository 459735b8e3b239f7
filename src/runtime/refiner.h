// Which splits and merges a view needs, in which order, within budgets.
//
// Each active vertex is evaluated once and then again only when the camera may have changed the
// answer: evaluation also finds a leeway, by which the camera may move without changing it, and a
// date on an odometer that turns so much for each length travelled and each radian turned. A frame
// compares the dates of all active vertices (4 bytes each, in a row) with the odometer and
// evaluates those that are due. Queues: splits by what is most visible, merges by what is least.
#pragma once

#include "crease/adaptive_mesh.h"
#include "runtime/active_cut.h"
#include "runtime/view_error.h"

#include <cstdint>
#include <vector>

namespace crease {

class Refiner {
 public:
  UpdateReport update(ActiveCut& cut, const ViewParameters& view);
  UpdateReport set_error(ActiveCut& cut, float error);
  std::size_t bytes() const {
    return 4 * due_.capacity() + sizeof(Wish) * (splits_.capacity() + merges_.capacity());
  }

 private:
  struct Wish {
    float excess;  // of what is to be split, or merged
    SplitId split;
    std::uint32_t slot;  // of its vertex, for splits
  };

  void look_from(const ActiveCut& cut, const ViewParameters& view);
  void evaluate_due(const ActiveCut& cut);
  void evaluate(const ActiveCut& cut, std::uint32_t slot);
  float evaluate_split(const ActiveCut& cut, const ActiveVertex& v, std::uint32_t slot);
  float evaluate_merge(const ActiveCut& cut, const ActiveVertex& v, SplitId above);
  float turn_for(float share, float distance) const;

  bool out_of_time();
  void do_merges(ActiveCut& cut);
  void do_splits(ActiveCut& cut);
  void keep_to_budget(ActiveCut& cut, const Wish& wanted, std::size_t room);
  void split(ActiveCut& cut, std::uint32_t slot);
  void split_consistently(ActiveCut& cut, std::uint32_t slot);
  void merge(ActiveCut& cut, SplitId s);
  bool needs_split(const ActiveCut& cut, SplitId s, std::uint32_t& third) const;
  bool is_needed(const ActiveCut& cut, SplitId s) const;

  ViewParameters view_;
  ViewError error_;
  bool has_view_ = false;
  float merge_below_ = 1;
  double odometer_ = 0, radians_per_length_ = 1;
  std::vector<float> due_;             // per slot, on the odometer
  std::vector<Wish> splits_, merges_;  // heaps: most visible first, least visible first
  bool counts_all_merges_ = false;     // merges_ has every possible one (a triangle budget binds)
  std::vector<std::uint32_t> pending_;
  UpdateReport report_;
  double stop_at_ = 0;
  std::uint32_t moves_until_clock_ = 0;
};

}  // namespace crease
