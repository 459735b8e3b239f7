// A cut through the vertex hierarchy of one block, beside those of the blocks around it.
//
//   BlockCut cut(block, hierarchy);
//   cut.set_wants(held, taken);                   // by finer blocks
//   cut.update(view);
//   if (cut.finish()) ...                         // what it wants of coarser ones is another thing
//   draw(cut.draw_list());
//
// No two blocks of a band split the same vertex, since those that patches share are locked. So each
// vertex is decided on by one block, the one that splits it, and blocks need to agree on two things
// only.
// (1) Where a root is split, all roots of the triangles around it are active, that is: they are in
//     the coarser blocks that made them. needed_roots() says which, and there they are held.
// (2) A triangle is shown by the finest block in which one of its corners is under a split root. By
//     (1) all its roots are active there, so that its corners are where the block says. takes()
//     says which triangles of its coarse end are shown by the block or by finer ones; those that
//     have them at their fine ends leave them out.
// With both, what is shown is every triangle with the active ancestors of its corners, as for one
// hierarchy of the whole model.
#pragma once

#include "crease/block_mesh.h"
#include "runtime/active_cut.h"
#include "runtime/block_hierarchy.h"
#include "runtime/cut_drawing.h"
#include "runtime/geomorphs.h"
#include "runtime/refiner.h"
#include "runtime/resident_block.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

class BlockCut {
 public:
  // `bounds`: of the splits, in place of the hierarchy's; look_anew() says that they have changed.
  BlockCut(ResidentBlockPtr block, BlockHierarchyPtr hierarchy,
           std::span<const SplitBounds> bounds);
  void look_anew() {
    refiner_.look_anew();
    is_stale_ = true;
  }
  BlockCut(const BlockCut&) = delete;
  BlockCut& operator=(const BlockCut&) = delete;

  // Of finer blocks: per vertex of the fine end whether it must be active, and per triangle whether
  // it is shown there.
  void set_wants(std::vector<char> held, std::vector<char> taken);
  // Until then the view is the one of before, if there was one.
  bool wants_update(const ViewParameters& view) const { return is_stale_ || !(view == view_); }
  UpdateReport update(const ViewParameters& view);
  const ViewParameters& view() const { return view_; }
  bool has_view() const { return has_view_; }

  // After set_wants() and update(): true if needed_roots() or takes() have changed.
  bool finish();
  std::span<const char> needed_roots() const { return needed_roots_; }
  std::span<const char> takes() const { return takes_; }  // per triangle of the coarse end

  // What is shown. `revision()` is another number whenever it has changed.
  DrawList draw_list() const;
  std::uint64_t revision() const { return revision_; }
  // Which triangle of the block's fine end one of draw_list() is.
  std::uint32_t triangle_of(Part part, std::uint32_t shown) const {
    return (part == kSnPart ? sn_ : part == kFnPart ? fn_ : nsn_).triangles[shown];
  }
  bool is_shown(TriangleId t) const { return shows_[data().triangle_of[index_of(t)]] != 0; }
  LevelError error() const;  // of the active vertices that something finer stands for
  std::size_t bytes() const;

  const ResidentBlock& block() const { return *block_; }
  const BlockHierarchy::Data& data() const { return hierarchy_->data(); }
  const ActiveCut& cut() const { return cut_; }
  std::span<const SplitBounds> bounds() const { return bounds_; }  // per split

 private:
  struct ShownPart {
    std::vector<std::uint32_t> indices, materials;
    std::vector<std::uint32_t> triangles;  // of the fine end
    std::vector<Vec3f> normals;
    std::vector<std::array<float, 4>> colors;
    std::vector<std::array<float, 2>> texcoords;

    DrawPart draw() const { return {indices, normals, materials, colors, texcoords}; }
    std::size_t bytes() const;
  };

  bool find_split_roots();
  void find_shown();
  void copy_shown(const DrawPart& all, const ActiveTriangles& triangles, ShownPart& shown) const;

  const ResidentBlockPtr block_;
  const BlockHierarchyPtr hierarchy_;
  const std::span<const SplitBounds> bounds_;
  ActiveCut cut_;
  const Geomorphs at_rest_;
  Refiner refiner_;
  CutDrawing drawing_;
  ViewParameters view_;
  bool has_view_ = false, is_stale_ = true, has_moved_ = true, has_new_taken_ = false;
  std::vector<char> held_, taken_;          // per vertex, per triangle
  std::vector<char> is_root_split_;         // per root, at the last finish()
  std::vector<char> needed_roots_, takes_;  // per root, per triangle of the coarse end
  std::vector<char> shows_;                 // per triangle
  ShownPart sn_, fn_, nsn_;
  std::uint64_t revision_ = 0;
};

}  // namespace crease
