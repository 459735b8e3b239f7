// The triangles of a block while its splits are undone, in any order in which children come before
// their parents.
#pragma once

#include "codec/patch_mesh.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

class ContractingPatch {
 public:
  explicit ContractingPatch(const PatchMesh& fine)
      : corners_(fine.triangles),
        is_alive_(fine.triangles.size(), 1),
        around_(fine.positions.size()) {
    for (std::uint32_t t = 0; t < corners_.size(); ++t) {
      for (const std::uint32_t v : corners_[t]) around_[v].push_back(t);
    }
  }

  const Corners& corners(std::uint32_t t) const { return corners_[t]; }
  bool is_alive(std::uint32_t t) const { return is_alive_[t] != 0; }
  // The triangles at v, all of them alive.
  std::span<const std::uint32_t> around(std::uint32_t v) const { return around_[v]; }

  // Replaces `second` by `first`. Those that have both vanish; they are what is returned, with
  // their corners as they were, until the next call.
  std::span<const std::uint32_t> contract(std::uint32_t first, std::uint32_t second) {
    vanished_.clear();
    moved_count_ = 0;
    std::vector<std::uint32_t>& at_first = around_[first];
    for (const std::uint32_t t : around_[second]) {
      Corners& corners = corners_[t];
      if (std::find(corners.begin(), corners.end(), first) != corners.end()) {
        vanished_.push_back(t);
        is_alive_[t] = 0;
      } else {
        std::replace(corners.begin(), corners.end(), second, first);
        at_first.push_back(t);
        ++moved_count_;
      }
    }
    around_[second].clear();
    for (const std::uint32_t t : vanished_) {
      for (const std::uint32_t v : corners_[t]) std::erase(around_[v], t);
    }
    return vanished_;
  }

  // How many of the last ones in around(first) came from `second` with the last call.
  std::size_t moved_count() const { return moved_count_; }

 private:
  std::vector<Corners> corners_;
  std::vector<char> is_alive_;
  std::vector<std::vector<std::uint32_t>> around_;
  std::vector<std::uint32_t> vanished_;
  std::size_t moved_count_ = 0;
};

}  // namespace crease::codec
