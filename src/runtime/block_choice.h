// Which blocks a view wants.
#pragma once

#include "crease/block_mesh.h"
#include "runtime/block_graph.h"
#include "runtime/triangle_budget.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace crease {

class BlockChooser {
 public:
  explicit BlockChooser(const BlockGraph& graph, const Grid& grid)
      : graph_(graph), grid_(grid), budget_(graph) {}

  struct Limits {
    std::size_t max_bytes = 0;
    std::span<const std::size_t> bytes_of_block;  // per block
    std::span<const char> is_refined;             // per block: the cut goes through it
    std::span<const ResidentBlockPtr> resident;   // per block
    const LevelChoice* levels = nullptr;          // null: blocks are shown whole or not at all
  };
  // Those whose coarse ends are seen to be wrong and what they need: the most visible errors first,
  // what a block needs before it, until the limits' bytes are used up, and as far as the view's
  // triangles allow (runtime/triangle_budget.h). The base always. Where all are resident and there
  // is room for all, they are in ascending order instead, which takes no sorting. Time O(blocks
  // that are wrong and next to them).
  std::span<const std::uint32_t> choose(const ViewParameters& view, const Limits& limits);

  // Those that the last choose() found wrong, in no order.
  std::span<const SeenBlock> wrong() const { return wrong_; }
  std::size_t evaluated() const { return evaluated_; }  // by the last choose()
  bool has_all() const { return has_all_; }             // the last choose() was without sorting
  // Per block, at which the last choose() has room for it; empty: triangles are no matter.
  std::span<const std::uint8_t> levels() const {
    return has_levels_ ? budget_.levels() : std::span<const std::uint8_t>();
  }

 private:
  void find_wrong(const ViewParameters& view, const Limits& limits);
  bool choose_all(const ViewParameters& view, const Limits& limits);
  void see_wrong(const ViewError& error);
  void spend_triangles(const ViewParameters& view, const Limits& limits, const ViewError& error);
  bool is_there(std::span<const std::uint32_t> blocks, const Limits& limits) const;
  static bool fits(std::span<const std::uint32_t> blocks, const Limits& limits);
  void choose_most_visible(const Limits& limits);
  void collect_needed(std::uint32_t block);
  bool is_chosen(std::uint32_t block) const { return chosen_at_[block] == round_; }

  const BlockGraph& graph_;
  Grid grid_;
  std::uint64_t round_ = 0;
  std::size_t evaluated_ = 0;
  bool has_all_ = false, has_levels_ = false;
  std::vector<std::uint64_t> chosen_at_;  // per block: the round
  // Per block. Of the round it was seen at: what it needs and is not known to be wrong.
  struct Seen {
    std::uint32_t round = 0, open_dependencies = 0;
  };
  std::vector<Seen> seen_;
  std::vector<std::uint64_t> needed_bits_;  // per block, while all are chosen
  std::vector<SeenBlock> wrong_;
  TriangleBudget budget_;
  // What it was last spent for.
  ViewParameters spent_view_;
  std::size_t spent_bytes_ = 0;
  bool spent_on_levels_ = false;
  std::vector<std::uint32_t> queue_, needed_, chosen_;
};

}  // namespace crease
