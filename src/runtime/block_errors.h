// How wrong the vertices of a block are. A file says of each block's ends how wrong the worst
// vertex is; what each contraction adds follows from the shapes. So the errors of all vertices
// follow from those at the fine end, and these are known where the finer blocks are, whose roots
// they are: from the finest blocks on, whose fine ends are right, they are those of a hierarchy of
// the whole model. Until a finer block has come the worst vertex's stands for its.
//
//   BlockErrors errors(data);                    // by what the file says
//   errors.tighten(vertex, finer.of_root(root)); // of any vertices of the fine end
//   if (errors.settle().of_roots) ...            // coarser blocks can know more
//
// They only get smaller, and are good whatever is dropped. Memory: 8 bytes a vertex, 14 a split.
#pragma once

#include "crease/split_bounds.h"
#include "runtime/block_hierarchy.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

class BlockErrors {
 public:
  explicit BlockErrors(const BlockHierarchy::Data& data);

  void tighten(std::uint32_t vertex, const RoundedError& error);
  struct Change {
    bool of_splits = false, of_roots = false;
  };
  // What is other than before. Time O(vertices) if tighten() told anything new.
  Change settle();

  // Per split. Changes with settle().
  std::span<const SplitBounds> bounds() const { return bounds_; }
  RoundedError of_root(std::uint32_t root) const;
  std::span<const RoundedError> of_vertices() const { return of_vertex_; }  // at the fine end
  std::size_t bytes() const;

 private:
  const BlockHierarchy::Data& data_;
  std::vector<RoundedError> of_vertex_;  // at the fine end
  std::vector<SplitBounds> bounds_;
  bool is_new_ = true, has_new_root_ = false;
};

}  // namespace crease
