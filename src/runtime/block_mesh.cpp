#include "crease/block_mesh.h"

#include "base/assert.h"
#include "runtime/block_mesh_impl.h"
#include "runtime/extract_blocks.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace crease {

using codec::ModelSchema;

Result<BlockMesh> BlockMesh::open(const BlockFile& file) {
  Result<ModelSchema> schema = codec::read_schema(file);
  if (!schema.ok()) return schema.failure();
  return BlockMesh(
      std::make_unique<Impl>(*std::move(schema), file.block_count(), file.page_count()));
}

BlockMesh BlockMesh::another() const {
  return BlockMesh(std::make_unique<Impl>(impl_.get()));
}

BlockMesh::BlockMesh(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BlockMesh::~BlockMesh() = default;
BlockMesh::BlockMesh(BlockMesh&&) noexcept = default;

std::optional<std::uint32_t> BlockMesh::next_page() const {
  if (impl_->graph.pages_added() >= impl_->page_count) return std::nullopt;
  return impl_->graph.pages_added();
}

Status BlockMesh::add_page(const DirectoryPage& page) {
  if (Status status = impl_->graph.add_page(page); !status.ok()) return status.failure();
  impl_->make_room();
  return Done{};
}

void BlockMesh::set_part_names(std::vector<std::string> names) {
  CREASE_ASSERT(names.size() == impl_->schema->coding.part_count || names.empty());
  impl_->part_names = std::move(names);
}

std::span<const std::string> BlockMesh::part_names() const {
  return impl_->part_names;
}

BlockUpdate BlockMesh::update(const BlockViewParameters& parameters) {
  return impl_->update(parameters);
}

std::vector<UnusedPtr> BlockMesh::take_unused() {
  return std::exchange(impl_->unused, {});
}

std::span<const BlockEntry> BlockMesh::missing() const {
  return impl_->missing;
}

std::vector<BlockEntry> BlockMesh::missing_for(const BlockViewParameters& parameters) const {
  std::vector<BlockEntry> missing;
  BlockChooser chooser(impl_->graph, impl_->schema->facts.grid);
  const bool is_limited = Impl::is_limited_by_vertex(parameters);
  const ViewParameters view =
      is_limited ? Impl::with_errors(parameters.view, impl_->search.trial()) : parameters.view;
  for (const std::uint32_t block : chooser.choose(view, impl_->limits(parameters))) {
    if (!impl_->resident[block] && impl_->wanted_at[block] != impl_->updates) {
      missing.push_back(impl_->graph.entry(block));
    }
  }
  return missing;
}

std::optional<BlockDecodeJob> BlockMesh::decode_job(BlockId id) const {
  if (index_of(id) >= impl_->graph.size() || impl_->resident[index_of(id)]) return std::nullopt;
  const auto block = static_cast<std::uint32_t>(index_of(id));
  auto data = std::make_unique<BlockDecodeJob::Data>();
  data->entry = impl_->graph.entry(block);
  data->schema = impl_->schema;
  for (const std::uint32_t needed : impl_->graph.dependencies(block)) {
    if (!impl_->resident[needed]) return std::nullopt;
    data->needed.push_back(impl_->resident[needed]);
  }
  return BlockDecodeJob(std::move(data));
}

std::vector<BlockId> BlockMesh::lacking(BlockId id) const {
  std::vector<BlockId> lacking;
  for (const std::uint32_t needed :
       impl_->graph.dependencies(static_cast<std::uint32_t>(index_of(id)))) {
    if (!impl_->resident[needed]) lacking.push_back(impl_->graph.entry(needed).id);
  }
  return lacking;
}

void BlockMesh::insert(ResidentBlockPtr block) {
  CREASE_ASSERT(block != nullptr && block->data().schema == impl_->schema);
  ResidentBlockPtr& place = impl_->resident[index_of(block->id())];
  if (place) return;
  impl_->resident_bytes += block->bytes();
  impl_->bytes_of_block[index_of(block->id())] = block->bytes();
  ++impl_->resident_count;
  // As if it had just been wanted: what was prefetched is not the first to go.
  std::uint64_t& wanted_at = impl_->wanted_at[index_of(block->id())];
  wanted_at = std::max(wanted_at, impl_->updates);
  impl_->runs[index_of(block->id())] = impl_->runs_of(*block);
  place = std::move(block);
  impl_->has_changed = true;
}

std::span<const BlockId> BlockMesh::missing_hierarchies() const {
  return impl_->missing_hierarchies;
}

std::optional<BlockHierarchyJob> BlockMesh::hierarchy_job(BlockId id) const {
  ResidentBlockPtr block = resident(id);
  if (!block) return std::nullopt;
  std::vector<ResidentBlockPtr> needed;
  for (const std::uint32_t n : impl_->graph.dependencies(std::uint32_t(index_of(id)))) {
    if (!impl_->resident[n]) return std::nullopt;
    needed.push_back(impl_->resident[n]);
  }
  return BlockHierarchyJob(std::move(block), std::move(needed));
}

void BlockMesh::insert(BlockHierarchyPtr hierarchy) {
  CREASE_ASSERT(hierarchy != nullptr);
  const auto block = static_cast<std::uint32_t>(index_of(hierarchy->id()));
  if (!is_resident(hierarchy->id())) return;
  impl_->cuts.insert(std::move(hierarchy));
  impl_->count_bytes(block);
  impl_->has_changed = true;
}

BlockHierarchyPtr BlockMesh::hierarchy(BlockId id) const {
  return impl_->cuts.hierarchy(static_cast<std::uint32_t>(index_of(id)));
}

std::span<const BlockId> BlockMesh::missing_levels() const {
  return impl_->missing_levels;
}

std::optional<BlockLevelsJob> BlockMesh::levels_job(BlockId id,
                                                    std::span<const BlockMesh> beside) const {
  auto data = std::make_unique<BlockLevelsJob::Data>();
  data->block = resident(id);
  if (!data->block) return std::nullopt;
  const auto block = static_cast<std::uint32_t>(index_of(id));
  for (const std::uint32_t n : impl_->graph.dependencies(block)) {
    if (!impl_->resident[n]) return std::nullopt;
    data->needed.push_back(impl_->resident[n]);
  }
  const auto add = [&](const BlockMesh& mesh, std::uint32_t finer) {
    LevelFactsPtr facts = mesh.impl_->levels.facts(finer);
    if (!facts) return false;
    data->finer.push_back({mesh.impl_->resident[finer], std::move(facts)});
    return true;
  };
  for (const std::uint32_t finer : impl_->graph.dependents(block)) {
    if (add(*this, finer)) continue;
    for (const BlockMesh& other : beside) {
      if (add(other, finer)) break;
    }
  }
  data->level = impl_->levels.wanted(block);
  return BlockLevelsJob(std::move(data));
}

void BlockMesh::insert(BlockLevelsPtr levels) {
  CREASE_ASSERT(levels != nullptr);
  if (!is_resident(levels->id())) return;
  impl_->levels.insert(std::move(levels));
  impl_->has_changed = true;
}

bool BlockMesh::has_arrived() const {
  return !impl_->was_by_vertex || (impl_->cuts.has_arrived() && !impl_->searches);
}

std::span<const ShownRange> BlockMesh::shown() const {
  return impl_->shown;
}

std::span<const ShownCut> BlockMesh::shown_cuts() const {
  return impl_->shown_cuts;
}

std::size_t BlockMesh::triangle_count() const {
  return impl_->triangles();
}

LevelError BlockMesh::error() const {
  LevelError error = impl_->error_of_cut();
  for (const std::uint32_t block : impl_->cut) {
    const BlockCut* const by_vertex = impl_->cuts.cut(block);
    if (by_vertex != nullptr) error = larger(error, by_vertex->error());
  }
  return error;
}

float BlockMesh::view_error() const {
  return impl_->view_error;
}

std::size_t BlockMesh::resident_count() const {
  return impl_->resident_count;
}

std::size_t BlockMesh::resident_bytes() const {
  return impl_->resident_bytes;
}

bool BlockMesh::is_resident(BlockId id) const {
  return index_of(id) < impl_->resident.size() && impl_->resident[index_of(id)] != nullptr;
}

ResidentBlockPtr BlockMesh::resident(BlockId id) const {
  return index_of(id) < impl_->resident.size() ? impl_->resident[index_of(id)] : nullptr;
}

std::size_t BlockMesh::bytes_of(const BlockFacts& facts) const {
  return resident_bytes_of(facts, *impl_->schema);
}

bool BlockMesh::is_refined(BlockId id) const {
  return index_of(id) < impl_->is_refined.size() && impl_->is_refined[index_of(id)] != 0 &&
         impl_->levels.shown(static_cast<std::uint32_t>(index_of(id))) > 0;
}

const ModelFacts& BlockMesh::facts() const {
  return impl_->schema->facts;
}

std::span<const Material> BlockMesh::materials() const {
  return impl_->schema->materials;
}

Mesh BlockMesh::extract() const {
  return extract_blocks(*impl_);
}

}  // namespace crease
