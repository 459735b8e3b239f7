// The triangles of a block while its splits are undone, in any order in which children come before
// their parents.
#pragma once

#include "codec/patch_mesh.h"
#include "codec/triangle_lists.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

class ContractingPatch {
 public:
  explicit ContractingPatch(const PatchMesh& fine) : corners_(fine.triangles) {
    around_.fill(fine.positions.size(), corners_, 0);
  }

  const Corners& corners(std::uint32_t t) const { return corners_[t]; }
  // The triangles at v, all of them alive; good until the next call of contract().
  std::span<const std::uint32_t> around(std::uint32_t v) const { return around_[v]; }

  // Replaces `second` by `first`. Those that have both vanish; they are what is returned, with
  // their corners as they were, until the next call.
  std::span<const std::uint32_t> contract(std::uint32_t first, std::uint32_t second) {
    vanished_.clear();
    moved_count_ = 0;
    for (std::size_t i = 0; i < around_[second].size(); ++i) {
      const std::uint32_t t = around_[second][i];
      Corners& corners = corners_[t];
      if (corners[0] == first || corners[1] == first || corners[2] == first) {
        vanished_.push_back(t);
      } else {
        corners[corner_of(corners, second)] = first;
        around_.add(first, t);
        ++moved_count_;
      }
    }
    around_.clear(second);
    for (const std::uint32_t t : vanished_) {
      for (const std::uint32_t v : corners_[t]) {
        if (v != second) around_.remove_if(v, [t](std::uint32_t other) { return other == t; });
      }
    }
    return vanished_;
  }

  // How many of the last ones in around(first) came from `second` with the last call.
  std::size_t moved_count() const { return moved_count_; }

 private:
  std::vector<Corners> corners_;
  TriangleLists around_;
  std::vector<std::uint32_t> vanished_;
  std::size_t moved_count_ = 0;
};

}  // namespace crease::codec
