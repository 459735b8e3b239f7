// A mesh that is fine where the camera looks and coarse elsewhere, block by block, larger than
// memory. The cut runs along the borders of blocks, which no block changes, so it has no
// crack; a frame only chooses which groups of triangles are drawn.
//
//   Result<BlockMesh> mesh = BlockMesh::open(*file);
//   while (auto page = mesh->next_page()) mesh->add_page(*file->read_page(*page));
//   every frame:
//     mesh->update({.view = {.camera = camera}, .max_bytes = 256 << 20});
//     for (const BlockEntry& entry : mesh->missing()) ...            // fetch, most valuable first
//     for (const ShownRange& range : mesh->shown()) draw(*range.block, range.sn, ...);
//     for (const ShownCut& cut : mesh->shown_cuts()) draw(cut.list);  // most of it, once there are
//   whenever a payload has come:
//     if (auto job = mesh->decode_job(id)) block = job->run(payload);  // on any thread
//     mesh->insert(*block);
//
// By vertex, what is shown is as fine as AdaptiveMesh would have it, vertex by vertex, as far as
// blocks are resident:
//
//   mesh->update({.view = {.camera = camera}, .by_vertex = true});
//   for (const ShownRange& range : mesh->shown()) ...                 // blocks shown whole
//   for (const ShownCut& cut : mesh->shown_cuts()) draw(cut.list);    // and those by vertex
//   for (BlockId id : mesh->missing_hierarchies())                    // whenever there is time
//     if (auto job = mesh->hierarchy_job(id)) mesh->insert(job->run());  // on any thread
//
// A block has a vertex hierarchy of its own, made of what its splits did, and a cut through it. A
// vertex of a finer block's coarse end is split only where all vertices that share a triangle with
// it are active in the coarser blocks; so much more is shown than by vertex over the whole model.
// A triangle is shown by the finest block in which one of its vertices is split. How wrong a vertex
// is at a block's fine end is known from the hierarchies of the finer blocks, of those that have
// been there; so with more of them the same view may show less.
//
// By block, a block need not be shown whole or not at all: where its coarse end is off by little
// more than is allowed, a mesh of it between its ends will do. It comes as a list of its own:
//
//   for (const ShownCut& cut : mesh->shown_cuts()) draw(cut.list);
//   for (BlockId id : mesh->missing_levels())                         // whenever there is time
//     if (auto job = mesh->levels_job(id)) mesh->insert(job->run());  // on any thread
//
// Until then the block is shown whole.
//
// BlockMesh does no input and has no threads: crease/block_streamer.h feeds one. What is shown is
// at every moment a cut of blocks that are resident, however few they are; without any it is empty.
#pragma once

#include "crease/adaptive_mesh.h"
#include "crease/block_file.h"
#include "crease/draw_changes.h"
#include "crease/draw_list.h"
#include "crease/mesh.h"
#include "crease/result.h"
#include "crease/shading.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crease {

// Triangles of a block that one block of the next finer band goes on with, and near each other: few
// enough to be left out where they are beside the view (crease/block_view.h). Each range is one of
// triangles in that part of the block's draw list; those of consecutive groups follow each other.
struct BlockGroup {
  std::uint32_t patch = 0;  // of the next finer band; 0 where there is none
  Range sn, fn, nsn;
  Vec3f low, high;  // a box around them, as positions of the draw list
};

// A block that was decoded: its triangles at the fine end, and what finer blocks start from. Does
// not change.
class ResidentBlock {
 public:
  struct Data;
  explicit ResidentBlock(std::unique_ptr<const Data> data);
  ~ResidentBlock();

  BlockId id() const;
  const BlockFacts& facts() const;  // what the directory says of it
  // All triangles of the fine end, group by group. All blocks have the same origin, and a vertex
  // that several have has the same floats in all of them. Views into the block.
  DrawList draw_list() const;
  // To which of the model's parts (BlockMesh::part_names()) a triangle of that kind in it belongs;
  // the first where it has none.
  PartId part_of(TriangleKind kind, std::size_t triangle) const;
  std::span<const BlockGroup> groups() const;  // ascending by patch, of which each may have several
  std::size_t bytes() const;                   // of memory that it takes
  const Data& data() const { return *data_; }  // for the library

 private:
  std::unique_ptr<const Data> data_;
};
using ResidentBlockPtr = std::shared_ptr<const ResidentBlock>;

// Holds what decoding a block takes, so that it runs on any thread, whatever becomes of the mesh's
// other blocks meanwhile.
class BlockDecodeJob {
 public:
  struct Data;
  explicit BlockDecodeJob(std::unique_ptr<const Data> data);
  ~BlockDecodeJob();
  BlockDecodeJob(BlockDecodeJob&&) noexcept;

  const BlockEntry& entry() const;
  // Fails, naming the block, if the payload is not what the directory says. Memory while it runs:
  // entry().facts.decoded_bytes at most, beside the result.
  Result<ResidentBlockPtr> run(std::span<const std::byte> payload) const;

 private:
  std::unique_ptr<const Data> data_;
};

// The vertices of one block between its two ends. Does not change.
class BlockHierarchy {
 public:
  struct Data;
  explicit BlockHierarchy(std::unique_ptr<const Data> data);
  ~BlockHierarchy();

  BlockId id() const;
  std::size_t bytes() const;                   // of memory that it takes
  const Data& data() const { return *data_; }  // for the library

 private:
  std::unique_ptr<const Data> data_;
};
using BlockHierarchyPtr = std::shared_ptr<const BlockHierarchy>;

// Holds what making it takes, so that it runs on any thread.
class BlockHierarchyJob {
 public:
  // `needed`: the blocks that `block` needs, ascending.
  BlockHierarchyJob(ResidentBlockPtr block, std::vector<ResidentBlockPtr> needed);
  BlockId id() const { return block_->id(); }
  // Time: about that of decoding the block three times; memory while it runs likewise. A block that
  // has no hierarchy, since a vertex has more than 65,534 attributes, gets an empty one and is
  // shown whole.
  BlockHierarchyPtr run() const;

 private:
  ResidentBlockPtr block_;
  std::vector<ResidentBlockPtr> needed_;
};

// How wrong a block is between its two ends, and what it shows at one of the levels there. Does not
// change.
class BlockLevels {
 public:
  struct Data;
  explicit BlockLevels(std::unique_ptr<const Data> data);
  ~BlockLevels();

  BlockId id() const;
  const Data& data() const { return *data_; }  // for the library

 private:
  std::unique_ptr<const Data> data_;
};
using BlockLevelsPtr = std::shared_ptr<const BlockLevels>;

// Something that is to be freed.
using UnusedPtr = std::shared_ptr<const void>;

// Holds what making them takes, so that it runs on any thread.
class BlockLevelsJob {
 public:
  struct Data;
  explicit BlockLevelsJob(std::unique_ptr<const Data> data);
  ~BlockLevelsJob();
  BlockLevelsJob(BlockLevelsJob&&) noexcept;

  BlockId id() const;
  // Time and memory: those of a BlockHierarchyJob, of which nothing stays.
  BlockLevelsPtr run() const;

 private:
  std::unique_ptr<const Data> data_;
};

struct BlockViewParameters {
  // By block, of these: camera, degrees, max_triangles, hysteresis, coarse_outside,
  // silhouette_weight. The errors are bounds of whole blocks. By vertex, inside the blocks that are
  // refined so, all others as well; but max_seconds leaves some blocks as they were seen before,
  // for the next update(). max_triangles counts what is shown, and that is never more unless the
  // base is. The most visible errors are mended first. By block, what does not fit then is passed
  // over, and what is left goes to the next ones that it does for. By vertex, all that is seen has
  // one error, the smallest for which there are triangles enough: a few updates look for it,
  // without regard to max_seconds, and show less until blocks and hierarchies are there.
  ViewParameters view;
  // Of resident blocks. The most visible errors first; what does not fit stays coarse. By vertex,
  // hierarchies and cuts count as well, and cuts that grow may exceed it until the next update().
  std::size_t max_bytes = std::size_t(256) << 20;
  // May change with every update(). Blocks change over a few at a time, what they need first.
  bool by_vertex = false;
  // By block: blocks may be shown between their ends. False: only whole or not at all.
  bool in_levels = true;
};

// A run of groups of one block. Ranges are in triangles of the parts of its draw list.
struct ShownRange {
  const ResidentBlock* block = nullptr;
  Range sn, fn, nsn;

  std::size_t triangle_count() const { return std::size_t(sn.count) + fn.count + nsn.count; }
};

// What a block shows by vertex, or at a level between its ends.
struct ShownCut {
  const ResidentBlock* block = nullptr;
  DrawList list;  // into the mesh; as for AdaptiveMesh, with positions that no triangle uses
  // Another one whenever `list` has changed, however often the block comes and goes.
  std::uint64_t revision = 0;
  // At a level, all of the list, group by group; by vertex none.
  std::span<const BlockGroup> groups{};

  std::size_t triangle_count() const {
    return list.sn.triangle_count() + list.fn.triangle_count() + list.nsn.triangle_count();
  }
};

// How far what is shown within a sphere may be off, surface or line.
struct ErrorSphere {
  Vec3f center;  // as positions of draw lists
  float radius = 0, error = 0;
};

struct BlockUpdate {
  std::size_t refined = 0, coarsened = 0;  // blocks that the cut went through
  std::size_t splits = 0, merges = 0;      // by vertex
  std::size_t evaluated = 0;               // blocks of which it was asked whether they are wrong
  std::vector<BlockId> dropped;            // no longer resident: a renderer frees its copies
};

class BlockMesh {
 public:
  // Reads the schema: tables and materials. The directory comes by add_page().
  static Result<BlockMesh> open(const BlockFile& file);
  // Another mesh of the same file, for another view: with the pages and names that are there, and
  // no block. Blocks of the one may be inserted into the other, and are then in memory once.
  BlockMesh another() const;
  ~BlockMesh();
  BlockMesh(BlockMesh&&) noexcept;

  // The directory page to read next, none once all are there. Coarse blocks are on the first.
  std::optional<std::uint32_t> next_page() const;
  // The next one. Fails if it does not continue those before.
  Status add_page(const DirectoryPage& page);

  // Those of the file's parts, which lie at its end; without them extract() has no parts. As many
  // as the head says.
  void set_part_names(std::vector<std::string> names);
  std::span<const std::string> part_names() const;  // empty while they are not known

  // Moves the cut to what the view wants, as far as blocks are resident, and says what is missing
  // for the rest. Drops what was not wanted for longest while more than max_bytes are resident;
  // what the view wants is never dropped. Time: O(blocks near the cut), nothing while neither view
  // nor blocks change.
  BlockUpdate update(const BlockViewParameters& parameters);
  // What the last update() no longer needs: blocks that it dropped, lists of levels, and the like.
  // The next one frees what was not taken; but freeing may wait for threads that allocate, and so
  // is better done by those.
  std::vector<UnusedPtr> take_unused();
  // Of the last update(): wanted and not resident, most valuable first, what a block needs before
  // it.
  std::span<const BlockEntry> missing() const;
  // What another view would want beside: for prefetching along a motion. The same order.
  std::vector<BlockEntry> missing_for(const BlockViewParameters& parameters) const;

  // None where a block that it needs is not resident, or the block is resident itself.
  std::optional<BlockDecodeJob> decode_job(BlockId id) const;
  // What the block needs and is not resident; `id` must be of a page that was added.
  std::vector<BlockId> lacking(BlockId id) const;
  // From a job of this mesh, or of one that another() made. The cut goes through it with the next
  // update().
  void insert(ResidentBlockPtr block);

  // By vertex: blocks that are shown whole only because they have no hierarchy; coarse ones first.
  std::span<const BlockId> missing_hierarchies() const;
  // None where the block, or one that it needs, is not resident.
  std::optional<BlockHierarchyJob> hierarchy_job(BlockId id) const;
  // As for blocks. What is not resident any more is let go.
  void insert(BlockHierarchyPtr hierarchy);
  BlockHierarchyPtr hierarchy(BlockId id) const;  // null: there is none

  // By block: blocks of the cut of which levels are not known, or one that would do is not there,
  // or more is known since of finer blocks; in this order, and fine ones first.
  std::span<const BlockId> missing_levels() const;
  // None where the block, or one that it needs, is not resident. What the meshes of other views
  // know of finer blocks counts as well, so that they can share what comes of it.
  std::optional<BlockLevelsJob> levels_job(BlockId id,
                                           std::span<const BlockMesh> beside = {}) const;
  // As for blocks. What is not resident any more is let go.
  void insert(BlockLevelsPtr levels);

  // By vertex, all of the view is shown as the last update() wanted it, as far as blocks are
  // resident. By block that is so at once; levels show it with fewer triangles later.
  bool has_arrived() const;

  // Both until the next update(). Coarse blocks first.
  std::span<const ShownRange> shown() const;     // whole groups
  std::span<const ShownCut> shown_cuts() const;  // by vertex, or between two ends
  std::size_t triangle_count() const;            // of what is shown
  // As ResidentBlock::part_of(), of a triangle of cut.list; `cut` is one of shown_cuts().
  PartId part_of(const ShownCut& cut, TriangleKind kind, std::size_t triangle) const;
  // The largest of what is shown. By vertex O(vertices).
  LevelError error() const;
  // How wrong the worst of it is seen to be by the last update()'s view: what is off by just as
  // much as is allowed counts 1. 0: nothing is off by more than that. Where the eye is inside of a
  // block's sphere, it counts as a twentieth of the radius away from what is wrong.
  float view_error() const;

  // For pictures. Where such a group of a block that is shown whole is off: spheres that may reach
  // beyond it. None: nowhere.
  std::vector<ErrorSphere> errors_of(const ResidentBlock& block, const BlockGroup& group) const;
  // Per position of the list its surface or line error, whichever is larger. Time O(vertices).
  std::vector<float> error_of_position(const ShownCut& cut) const;

  std::size_t resident_count() const;
  std::size_t resident_bytes() const;
  bool is_resident(BlockId id) const;
  ResidentBlockPtr resident(BlockId id) const;  // null: it is not
  bool is_refined(BlockId id) const;            // the cut goes through it, above its coarse end
  // At most so many bytes, if it becomes resident.
  std::size_t bytes_of(const BlockFacts& facts) const;
  const ModelFacts& facts() const;
  std::span<const Material> materials() const;

  // What is shown as a mesh of its own, all attribute layers, materials and parts. Time O(shown).
  Mesh extract() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }  // for the library

 private:
  explicit BlockMesh(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace crease
