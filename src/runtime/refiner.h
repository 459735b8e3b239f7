// Which splits and merges a view needs, in which order, within budgets.
//
// Each active vertex is evaluated once and then again only when the camera may have changed the
// answer: evaluation also tells how far the camera may go until then (ViewError::Sight), which
// gives two dates, one on an odometer of lengths travelled and one on an odometer that turns for
// travels and turns together. A frame compares the dates of all active vertices (8 bytes each, in a
// row) with the odometers and evaluates those that are due. Queues: splits by what is most visible,
// merges by what is least.
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
    return sizeof(Dates) * due_.capacity() +
           sizeof(Wish) * (splits_.capacity() + merges_.capacity());
  }

 private:
  struct Wish {
    float excess;  // of what is to be split, or merged
    SplitId split;
    std::uint32_t slot;  // of its vertex, for splits
  };

  // On the odometers. Now, if it has to be looked at again by any other camera.
  struct Dates {
    float travel = 0, swing = 0;
  };

  void look_from(const ActiveCut& cut, const ViewParameters& view);
  void evaluate_due(const ActiveCut& cut);
  void evaluate(const ActiveCut& cut, std::uint32_t slot);
  Dates evaluate_split(const ActiveCut& cut, const ActiveVertex& v, std::uint32_t slot);
  Dates evaluate_merge(const ActiveCut& cut, const ActiveVertex& v, SplitId above);
  Dates dates_of(const ViewError::Sight& sight) const;

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
  double travelled_ = 0, swung_ = 0;  // the odometers
  double radians_per_length_ = 1;
  std::vector<Dates> due_;             // per slot
  std::vector<Wish> splits_, merges_;  // heaps: most visible first, least visible first
  bool counts_all_merges_ = false;     // merges_ has every possible one (a triangle budget binds)
  std::vector<std::uint32_t> pending_;
  UpdateReport report_;
  double stop_at_ = 0;
  std::uint32_t moves_until_clock_ = 0;
};

}  // namespace crease
