// The cuts by vertex of a BlockMesh, one a block, and what they want of each other.
//
//   VertexCuts cuts(graph);
//   cuts.insert(hierarchy);                                    // whenever one has come
//   const VertexCuts::Report report = cuts.update(blocks, view, true);
//   if (const BlockCut* cut = cuts.cut(block)) draw(cut->draw_list());   // else it is shown whole
//
// A block is by vertex only if all that it needs are; so what is shown whole is finer than what is
// by vertex around it, and all of its coarse end must be active there. Each update goes from fine
// blocks to coarse ones: what a block wants of coarser ones is known before they move.
#pragma once

#include "runtime/block_cut.h"
#include "runtime/block_errors.h"
#include "runtime/block_graph.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace crease {

class VertexCuts {
 public:
  explicit VertexCuts(const BlockGraph& graph) : graph_(graph) {}

  // The cut by block.
  struct Blocks {
    std::span<const ResidentBlockPtr> resident;
    std::span<const std::uint32_t> cut;  // ascending
    std::span<const char> is_refined;    // per block
  };
  struct Report {
    std::size_t splits = 0, merges = 0, evaluated = 0;
    bool have_changed = false;  // which blocks are by vertex
  };

  void insert(BlockHierarchyPtr hierarchy);
  void drop(std::uint32_t block);  // it is not resident any more
  void clear();                    // all cuts; hierarchies stay

  // `cut_has_changed`: since the last time.
  Report update(const Blocks& blocks, const ViewParameters& view, bool cut_has_changed);
  // All blocks that could be by vertex are, and have seen the last update()'s view.
  bool has_arrived() const { return has_arrived_; }

  // Null: it is shown whole, if at all.
  const BlockCut* cut(std::uint32_t block) const {
    return block < entries_.size() ? entries_[block].cut.get() : nullptr;
  }
  BlockHierarchyPtr hierarchy(std::uint32_t block) const {
    return block < entries_.size() ? entries_[block].hierarchy : nullptr;
  }
  std::size_t bytes_of(std::uint32_t block) const;  // hierarchy and cut

 private:
  // A vertex that a block starts from, and where it was made.
  struct Maker {
    std::uint32_t block = 0, vertex = 0, root = 0;
  };
  enum class Way : std::uint8_t { Hidden, Whole, ByVertex };
  struct Entry {
    BlockHierarchyPtr hierarchy;
    std::unique_ptr<BlockErrors> errors;
    std::unique_ptr<BlockCut> cut;
    bool is_stale = false;                // finer blocks may know more of its errors
    std::vector<Maker> makers;            // of its roots, by block; while it is refined
    std::vector<std::uint32_t> named_by;  // refined blocks whose roots it made
    Way way = Way::Hidden;
    bool wants_changed = false;  // in this update(): what it wants of coarser ones
    bool must_ask = false;       // others want something of it than did before
    std::uint64_t seen_in_round = 0;
  };

  void mark_stale(std::uint32_t block);
  void settle_errors(const Blocks& blocks);
  void tighten(std::uint32_t block, const Blocks& blocks);
  bool can_be_by_vertex(std::uint32_t block) const;
  bool choose_blocks(const Blocks& blocks);
  void link(const Blocks& blocks);
  void unlink(std::uint32_t block);
  void find_makers(const ResidentBlock& block, Entry& entry) const;
  static std::vector<std::uint32_t> makers_of(const Entry& entry);
  void move(const Blocks& blocks, const ViewParameters& view, Report& report);
  bool must_ask(std::uint32_t block) const;
  void ask_finer(std::uint32_t block, const Blocks& blocks);
  void ask_for_triangles(std::uint32_t block, const Blocks& blocks, std::vector<char>& taken) const;
  std::size_t first_triangle_in(std::uint32_t finer, std::uint32_t block,
                                const Blocks& blocks) const;

  const BlockGraph& graph_;
  std::vector<Entry> entries_;        // per block
  std::vector<std::uint32_t> stale_;  // a heap: finest first
  std::uint64_t round_ = 1;           // each block sees a view once a round
  bool has_changed_ = true;           // hierarchies have come or cuts have gone
  bool has_arrived_ = true;
};

}  // namespace crease
