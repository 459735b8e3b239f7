// The cuts by vertex of a BlockMesh, one a block, and what they want of each other.
//
//   VertexCuts cuts(graph, grid);
//   cuts.insert(hierarchy);                                    // whenever one has come
//   const VertexCuts::Report report = cuts.update(blocks, view, true);
//   if (const BlockCut* cut = cuts.cut(block)) ...             // else it is shown whole
//
// A block is by vertex only if all that it needs are; so what is shown whole is finer than what is
// by vertex around it, and all of its coarse end must be active there. Each update goes from fine
// blocks to coarse ones: what a block wants of coarser ones is known before they move. Time: that
// of what changes, and O(1) for each other block of the cut.
#pragma once

#include "runtime/block_cut.h"
#include "runtime/block_errors.h"
#include "runtime/block_graph.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace crease {

class VertexCuts {
 public:
  // What is no longer needed goes to `unused`.
  VertexCuts(const BlockGraph& graph, const Grid& grid, std::vector<UnusedPtr>& unused)
      : graph_(graph), grid_(grid), unused_(unused) {}

  // The cut by block.
  struct Blocks {
    std::span<const ResidentBlockPtr> resident;
    std::span<const std::uint32_t> cut;  // ascending
    std::span<const char> is_refined;    // per block
    bool are_known = false;  // the vertices of all, and none may be whole while others are made
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
  // Blocks of which bytes_of() may be another since the last update().
  std::span<const std::uint32_t> resized() const { return resized_; }

  // Null: it is shown whole, if at all.
  const BlockCut* cut(std::uint32_t block) const {
    return block < entries_.size() ? entries_[block].cut.get() : nullptr;
  }
  // Of a cut that shows something: per position of its draw list, surface or line.
  std::vector<float> error_of_position(std::uint32_t block) const;
  BlockHierarchyPtr hierarchy(std::uint32_t block) const {
    return block < entries_.size() ? entries_[block].hierarchy : nullptr;
  }
  // It can be by vertex, if all that it needs are.
  bool has_vertices(std::uint32_t block) const {
    return block < entries_.size() && entries_[block].hierarchy &&
           !entries_[block].hierarchy->data().is_empty;
  }
  std::size_t bytes_of(std::uint32_t block) const;  // hierarchy and cut

 private:
  enum class Way : std::uint8_t { Hidden, Whole, ByVertex };
  // Triangles of a block's coarse end from `first` on are, in order, those of `block` by patch from
  // `there` on.
  struct Source {
    std::uint32_t block = 0, first = 0, there = 0;
  };
  struct Entry {
    BlockHierarchyPtr hierarchy;
    std::unique_ptr<BlockErrors> errors;
    bool is_stale = false;   // finer blocks may know more of its errors
    Way way = Way::Hidden;   // what coarser blocks know of it
    ResidentBlockPtr block;  // while it is not hidden
    std::vector<Source> sources;
    std::vector<std::uint32_t> makers;  // of its roots and triangles, ascending
    std::unique_ptr<BlockCut> cut;
    std::uint64_t seen_in_round = 0;
  };

  void mark_stale(std::uint32_t block);
  void settle_errors(const Blocks& blocks);
  void tighten(std::uint32_t block, const Blocks& blocks);

  bool can_be_by_vertex(std::uint32_t block, std::span<const Way> ways) const;
  std::vector<Way> choose_ways(const Blocks& blocks);
  bool link(const Blocks& blocks);
  void hide(std::uint32_t block);
  void show(std::uint32_t block, Way way, const Blocks& blocks);
  std::vector<Source> sources_of(std::uint32_t block, const Blocks& blocks) const;
  std::vector<std::uint32_t> makers_of(const ResidentBlock& block) const;
  void want(std::uint32_t root, const Entry& entry, bool is_wanted);
  void take(std::uint32_t triangle, const Entry& entry, bool is_taken);
  void want_all(const Entry& entry, bool is_wanted, std::uint32_t of);
  void unwant(const Entry& entry);

  void look(const ViewParameters& view);
  void begin_round(const Blocks& blocks);
  void move(const Blocks& blocks, const ViewParameters& view, Report& report);
  void tell(Entry& entry);
  void let_rest(std::uint32_t block);

  const BlockGraph& graph_;
  const Grid grid_;
  std::vector<UnusedPtr>& unused_;
  std::vector<Entry> entries_;                  // per block
  std::vector<std::uint32_t> stale_, resized_;  // stale_: a heap, finest first
  struct Waiting {
    std::uint64_t since = 0;
    std::uint32_t block = 0;
  };
  std::deque<Waiting> waiting_to_rest_;
  ViewNow now_;
  std::uint64_t updates_ = 0;
  std::uint64_t round_ = 1;  // each block sees a view once a round
  bool has_changed_ = true;  // hierarchies have come or cuts have gone
  bool has_arrived_ = true;
};

}  // namespace crease
