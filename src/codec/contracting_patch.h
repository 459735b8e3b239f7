// The triangles of a block while its splits are undone, in any order in which children come before
// their parents.
#pragma once

#include "codec/patch_mesh.h"
#include "codec/triangle_lists.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace crease::codec {

class ContractingPatch {
 public:
  explicit ContractingPatch(const PatchMesh& fine)
      : ContractingPatch(fine.positions.size(), fine.triangles) {}
  ContractingPatch(std::size_t vertex_count, std::vector<Corners> triangles)
      : corners_(std::move(triangles)) {
    around_.fill(vertex_count, corners_, 0);
  }

  const Corners& corners(std::uint32_t t) const { return corners_[t]; }
  // The triangles at v, all of them alive; good until the next call of contract().
  std::span<const std::uint32_t> around(std::uint32_t v) const { return around_[v]; }

  void prefetch_around(std::uint32_t v) const { around_.prefetch(v); }

  // Replaces `second` by `first`. Those that have both vanish; they are what is returned, with
  // their corners as they were, until the next call.
  std::span<const std::uint32_t> contract(std::uint32_t first, std::uint32_t second) {
    const std::span<const std::uint32_t> around = around_[second];
    vanished_.resize(around.size());
    moved_.resize(around.size());
    std::size_t gone = 0;
    moved_count_ = 0;
    for (const std::uint32_t t : around) {  // without a branch, since nobody can tell which vanish
      const Corners& corners = corners_[t];
      const auto is_first = [&](std::size_t c) { return std::uint32_t(corners[c] == first); };
      const std::uint32_t vanishes = is_first(0) | is_first(1) | is_first(2);
      vanished_[gone] = moved_[moved_count_] = t;
      gone += vanishes;
      moved_count_ += 1 - vanishes;
    }
    vanished_.resize(gone);
    for (std::size_t i = 0; i < moved_count_; ++i) {
      Corners& corners = corners_[moved_[i]];
      corners[corner_of(corners, second)] = first;
    }
    around_.clear(second);
    for (const std::uint32_t t : vanished_) {
      const Corners& corners = corners_[t];
      const std::size_t c = corner_of(corners, second);
      around_.remove(corners[kCornerAfter[c]], t);
      around_.remove(corners[kCornerBefore[c]], t);
    }
    around_.add(first, std::span(moved_).first(moved_count_));
    return vanished_;
  }

  // Those that vanished with the last call.
  std::span<const std::uint32_t> vanished() const { return vanished_; }

  // How many of the last ones in around(first) came from `second` with the last call.
  std::size_t moved_count() const { return moved_count_; }

 private:
  std::vector<Corners> corners_;
  TriangleLists around_;
  std::vector<std::uint32_t> vanished_, moved_;
  std::size_t moved_count_ = 0;
};

}  // namespace crease::codec
