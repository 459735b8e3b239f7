// The state of a BlockMesh.
#pragma once

#include "codec/model_schema.h"
#include "crease/block_mesh.h"
#include "runtime/block_choice.h"
#include "runtime/block_graph.h"
#include "runtime/error_search.h"
#include "runtime/level_choice.h"
#include "runtime/resident_block.h"
#include "runtime/vertex_cuts.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease {

// The groups of a block that go on with the same patch.
struct PatchRun {
  std::uint32_t finer = 0;  // the block; kNone: there is none
  ShownRange range;
};

struct ListedCut {
  const ResidentBlock* block = nullptr;
  std::uint64_t revision = 0;
  std::size_t triangles = 0;
};

struct BlockMesh::Impl {
  Impl(codec::ModelSchema s, std::uint32_t blocks, std::uint32_t pages)
      : schema(std::make_shared<const codec::ModelSchema>(std::move(s))),
        page_count(pages),
        graph(schema->facts, blocks),
        chooser(graph, schema->facts.grid),
        levels(graph, unused),
        cuts(graph, schema->facts.grid, unused) {}
  // Of the same file, with no block.
  explicit Impl(const Impl* other)
      : schema(other->schema),
        part_names(other->part_names),
        page_count(other->page_count),
        graph(other->graph),
        chooser(graph, schema->facts.grid),
        levels(graph, unused),
        cuts(graph, schema->facts.grid, unused) {
    make_room();
  }

  void make_room();  // for what the graph has
  BlockUpdate update(const BlockViewParameters& parameters);
  std::vector<std::uint32_t> those_that_can_be(std::span<const std::uint32_t> chosen) const;
  void move_cut(std::vector<std::uint32_t> next, BlockUpdate& report);
  void drop_beyond(std::size_t max_bytes, BlockUpdate& report);
  bool choose_levels(const BlockViewParameters& parameters);
  void find_view_error(const ViewParameters& view, double errors);
  static bool is_limited_by_vertex(const BlockViewParameters& parameters);
  static ViewParameters with_errors(ViewParameters view, double errors);
  std::vector<std::uint32_t> those_by_vertex(std::vector<std::uint32_t> next) const;
  void move_within(const BlockViewParameters& parameters, bool have_changed, BlockUpdate& report);
  std::size_t triangles() const { return shown_triangles + cut_triangles; }
  void move_vertices(const BlockViewParameters& parameters, bool have_changed, BlockUpdate& report);
  void list_cuts();
  void list_missing_hierarchies();
  void count_bytes(std::uint32_t block);
  void count_resized_levels();
  void list_shown();
  void list_shown_of(std::uint32_t block);
  std::vector<PatchRun> runs_of(const ResidentBlock& block) const;
  bool is_shown(std::uint32_t block, std::uint32_t patch) const;
  LevelError error_of_cut() const;
  BlockChooser::Limits limits(const BlockViewParameters& parameters) const;

  std::shared_ptr<const codec::ModelSchema> schema;
  std::vector<std::string> part_names;
  std::uint32_t page_count;
  BlockGraph graph;
  BlockChooser chooser;
  // Per block.
  std::vector<ResidentBlockPtr> resident;
  std::vector<std::size_t> bytes_of_block;  // what it takes, or at most would
  std::vector<std::size_t> more_bytes;      // what levels and being by vertex take
  std::vector<std::vector<PatchRun>> runs;  // of resident ones
  std::vector<char> is_refined;             // it is in the cut: resident, and so is what it needs
  std::vector<std::uint64_t> wanted_at;     // the last update that wanted it
  std::vector<std::uint32_t> cut;           // those that are refined, ascending
  std::vector<std::uint32_t> could_be;      // and others whose vertices are not known yet
  std::vector<BlockEntry> missing;
  std::vector<UnusedPtr> unused;  // since the last update
  LevelChoice levels;
  VertexCuts cuts;
  ErrorSearch search;  // by vertex, while triangles are limited
  std::vector<BlockId> missing_hierarchies, missing_levels;
  std::vector<ShownRange> shown;
  std::vector<ShownCut> shown_cuts;
  std::vector<ListedCut> listed;  // of each what tells whether it is another one
  float view_error = 0;
  std::size_t shown_triangles = 0, cut_triangles = 0, resident_count = 0, resident_bytes = 0;
  std::uint64_t updates = 0;
  BlockViewParameters last;
  bool was_by_vertex = false;  // at the last update
  bool has_changed = true;     // since the last update
  bool searches = false;       // the next update makes another trial
};

}  // namespace crease
