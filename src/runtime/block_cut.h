// A cut through the vertex hierarchy of one block, beside those of the blocks around it.
//
//   BlockCut cut(block, hierarchy, errors.bounds());
//   cut.links().hold(vertex);                     // by finer blocks (runtime/block_links.h)
//   if (cut.must_update(now)) cut.update(now, true);
//   ... cut.links().root_changes() ...            // to be told coarser ones
//   cut.links().forget_changes();
//   if (cut.live() != nullptr) draw(cut.draw_list());
//
// Most blocks of a view are right as they are: where no root is wrong nothing is split, where all
// leaves are held and finer blocks show all triangles nothing can change. Such a block rests: it
// has no active vertices, only the roots' watches (WatchList) or not even these. And while none of
// its vertices can become wrong or right, as far as the camera has come, a block is not looked at.
#pragma once

#include "crease/block_mesh.h"
#include "runtime/active_cut.h"
#include "runtime/block_hierarchy.h"
#include "runtime/block_links.h"
#include "runtime/cut_drawing.h"
#include "runtime/geomorphs.h"
#include "runtime/refiner.h"
#include "runtime/resident_block.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace crease {

// A view, and how far the camera has come until then.
struct ViewNow {
  ViewParameters view;  // without budgets
  ViewError error;
  double travel = 0, turn = 0;
  // Another number for each view, and wherever anything else has changed than where the camera is
  // and looks.
  std::uint64_t number = 0, kind = 0;
};

class BlockCut {
 public:
  // `bounds`: of the splits, in place of the hierarchy's; look_anew() says that they have changed.
  BlockCut(ResidentBlockPtr block, BlockHierarchyPtr hierarchy,
           std::span<const SplitBounds> bounds);
  BlockCut(const BlockCut&) = delete;
  BlockCut& operator=(const BlockCut&) = delete;

  void look_anew();
  BlockLinks& links();
  void forget_changes() {
    if (links_) links_->forget_changes();
  }
  const BlockLinks* known_links() const { return links_.get(); }  // null: nothing is wanted

  // Something is wanted that was not, or the view may find something to do.
  bool must_update(const ViewNow& now) const { return is_dirty_ || is_due(now); }
  bool is_due(const ViewNow& now) const {
    return !is_whole_ && seen_ != now.number &&
           (kind_ != now.kind || !(due_travel_ > now.travel && due_turn_ > now.turn));
  }
  // `may_look`: else only what is wanted is done, and the view stays the one of before, if there
  // was one.
  UpdateReport update(const ViewNow& now, bool may_look);

  // After some updates with nothing to do: goes to rest, if it could_rest().
  bool could_rest() const;
  void rest();
  bool is_waiting_to_rest = false;  // for who asks

  // Null: it rests and shows nothing.
  const ActiveCut* live() const { return live_ ? &live_->cut : nullptr; }
  bool is_done(SplitId s) const { return live_ ? live_->cut.is_done(s) : is_whole_; }
  // What is shown, of a live one. `revision()` is another number whenever it has changed.
  DrawList draw_list() const;
  std::uint64_t revision() const { return revision_; }
  // Which triangle of the block's fine end one of draw_list() is.
  std::uint32_t triangle_of(Part part, std::uint32_t shown) const {
    return data().triangle_of[index_of(live_->cut.parts()[part].ids[shown])];
  }
  LevelError error() const;  // of the active vertices that something finer stands for
  std::size_t bytes() const;

  const ResidentBlock& block() const { return *block_; }
  const BlockHierarchy::Data& data() const { return hierarchy_->data(); }
  std::span<const SplitBounds> bounds() const { return bounds_; }  // per split

 private:
  struct Live {
    Live(const MeshHierarchy& hierarchy, const char* is_hidden)
        : cut(hierarchy, is_hidden), at_rest(hierarchy) {}

    ActiveCut cut;
    const Geomorphs at_rest;
    Refiner refiner;
    CutDrawing drawing;
    bool is_drawn = false;
  };

  bool is_covered() const;
  bool must_wake(const ViewNow& now, bool looks, UpdateReport& report);
  bool finds_wrong_root(const ViewNow& now, UpdateReport& report);
  void watch_roots(const ViewNow& now);
  void wake();
  UpdateReport move();
  void set_due(const ViewNow& now, const WatchList::Slack& slack);

  const ResidentBlockPtr block_;
  const BlockHierarchyPtr hierarchy_;
  const std::span<const SplitBounds> bounds_;
  std::unique_ptr<BlockLinks> links_;  // or none yet
  std::unique_ptr<Live> live_;         // or it rests
  bool is_whole_ = false;              // it rests with all splits done and nothing shown
  bool is_dirty_ = true, has_view_ = false;
  // Of the last view that it looked at, and until where that is good.
  ViewParameters view_;
  std::uint64_t seen_ = 0, kind_ = 0;
  double due_travel_ = 0, due_turn_ = 0;
  // While it rests with no root split: per split of a root; from where on the odometer counts.
  WatchList watched_roots_;
  double watched_from_travel_ = 0, watched_from_turn_ = 0;
  int looks_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace crease
