// What finer blocks want of a block, and what it wants of coarser ones, kept while both change.
//
// No two blocks of a band split the same vertex, since those that patches share are locked. So each
// vertex is decided on by one block, the one that splits it, and blocks need to agree on two things
// only.
// (1) Where a root is split, all roots of the triangles around it are active, that is: they are in
//     the coarser blocks that made them. There they are held.
// (2) A triangle is shown by the finest block in which one of its corners is under a split root. By
//     (1) all its roots are active there, so that its corners are where the block says. Those that
//     have it at their fine ends leave it out: it is taken.
// With both, what is shown is every triangle with the active ancestors of its corners, as for one
// hierarchy of the whole model.
//
//   links.hold(vertex);                      // by a finer block
//   links.set_root_split(root, true);        // by its own cut
//   for (const BlockLinks::Change& c : links.root_changes()) ...   // to be told coarser blocks
//
// Time of each call: O(depth), or O(triangles around a root). Memory: 4 bytes a vertex and a root,
// 2 a triangle, 1 a triangle of the coarse end and a split.
#pragma once

#include "runtime/block_hierarchy.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

class BlockLinks {
 public:
  explicit BlockLinks(const BlockHierarchy::Data& data);

  // Of finer blocks, by numbers at the fine end. Each holds a vertex as often as it releases it.
  void hold(std::uint32_t vertex);
  void release(std::uint32_t vertex);
  void take(std::uint32_t triangle, bool is_taken);
  // Of its own cut. Each root changes to what it was not.
  void set_root_split(std::uint32_t root, bool is_split);
  // Takes over which splits of roots are done, out of a bit per split.
  void set_root_splits(std::span<const std::uint64_t> done_words);

  // (1) and (2) for coarser blocks; of triangles of the coarse end.
  bool needs(std::uint32_t root) const { return needed_[root] > 0; }
  bool takes(std::uint32_t t) const { return split_corners_[t] > 0 || is_taken_[t] != 0; }
  struct Change {
    std::uint32_t index = 0;  // of a root, or of a triangle of the coarse end
    bool is_on = false;
  };
  // In this order.
  std::span<const Change> root_changes() const { return root_changes_; }
  std::span<const Change> triangle_changes() const { return triangle_changes_; }
  void forget_changes();

  // For its own cut: per split whether leaves below must be active (Refiner), per triangle of the
  // hierarchy whether it is hidden (ActiveCut), and what of that has changed.
  std::span<const std::uint8_t> required() const { return required_; }
  const std::vector<char>& hidden() const { return is_hidden_; }
  bool is_held(std::uint32_t vertex) const { return held_[vertex] > 0; }
  std::span<const std::uint32_t> newly_held() const { return newly_held_; }
  std::span<const SplitId> required_changes() const { return required_changes_; }
  std::span<const TriangleId> hidden_changes() const { return hidden_changes_; }

  std::size_t required_count() const { return required_count_; }
  std::size_t split_root_count() const { return split_root_count_; }
  std::size_t hidden_count() const { return hidden_count_; }
  bool is_unused() const { return held_count_ + taken_count_ + split_root_count_ == 0; }
  std::size_t bytes() const;

 private:
  void set_hidden(std::uint32_t t);
  void tell_taking(std::uint32_t t, bool took_before);

  const BlockHierarchy::Data& data_;
  std::vector<std::uint32_t> held_;          // per vertex: by how many
  std::vector<std::uint8_t> required_;       // per split: children that are required
  std::vector<char> is_taken_;               // per triangle
  std::vector<std::uint8_t> split_corners_;  // per triangle of the coarse end: at split roots
  std::vector<char> is_hidden_;              // per triangle of the hierarchy
  std::vector<std::uint32_t> needed_;        // per root: split ones in its ring
  std::vector<std::uint64_t> split_roots_;   // a bit per split of a root
  std::size_t held_count_ = 0, required_count_ = 0, taken_count_ = 0, hidden_count_ = 0,
              split_root_count_ = 0;
  std::vector<Change> root_changes_, triangle_changes_;
  std::vector<std::uint32_t> newly_held_;
  std::vector<SplitId> required_changes_;
  std::vector<TriangleId> hidden_changes_;
};

}  // namespace crease
