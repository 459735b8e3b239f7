#include "crease/block_mesh.h"

#include "base/assert.h"
#include "codec/join_ends.h"
#include "runtime/block_choice.h"
#include "runtime/block_graph.h"
#include "runtime/resident_block.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace crease {

using codec::ModelSchema;

struct BlockMesh::Impl {
  Impl(ModelSchema s, std::uint32_t blocks, std::uint32_t pages)
      : schema(std::make_shared<const ModelSchema>(std::move(s))),
        page_count(pages),
        graph(schema->facts, blocks),
        chooser(graph, schema->facts.grid) {}
  // Of the same file, with no block.
  explicit Impl(const Impl* other)
      : schema(other->schema),
        part_names(other->part_names),
        page_count(other->page_count),
        graph(other->graph),
        chooser(graph, schema->facts.grid) {
    make_room();
  }

  void make_room();  // for what the graph has
  BlockUpdate update(const BlockViewParameters& parameters);
  void move_cut(std::span<const std::uint32_t> chosen, BlockUpdate& report);
  void drop_beyond(std::size_t max_bytes, BlockUpdate& report);
  void list_shown();
  void list_shown_of(std::uint32_t block);
  bool is_shown(std::uint32_t block, std::uint32_t patch) const;
  LevelError error_of_cut() const;
  BlockChooser::Limits limits(const BlockViewParameters& parameters) const;

  std::shared_ptr<const ModelSchema> schema;
  std::vector<std::string> part_names;
  std::uint32_t page_count;
  BlockGraph graph;
  BlockChooser chooser;
  // Per block.
  std::vector<ResidentBlockPtr> resident;
  std::vector<std::size_t> bytes_of_block;  // what it takes, or at most would
  std::vector<char> is_refined;             // it is in the cut: resident, and so is what it needs
  std::vector<std::uint64_t> wanted_at;     // the last update that wanted it
  std::vector<std::uint32_t> cut;           // those that are refined, ascending
  std::vector<BlockEntry> missing;
  std::vector<ShownRange> shown;
  LevelError shown_error;
  float view_error = 0;
  std::size_t shown_triangles = 0, resident_count = 0, resident_bytes = 0;
  std::uint64_t updates = 0;
  BlockViewParameters last;
  bool has_changed = true;  // since the last update
};

void BlockMesh::Impl::make_room() {
  const std::uint32_t count = graph.size();
  resident.resize(count);
  for (auto block = static_cast<std::uint32_t>(bytes_of_block.size()); block < count; ++block) {
    bytes_of_block.push_back(resident_bytes_of(graph.entry(block).facts, *schema));
  }
  is_refined.resize(count, 0);
  wanted_at.resize(count, 0);
  has_changed = true;
}

BlockChooser::Limits BlockMesh::Impl::limits(const BlockViewParameters& parameters) const {
  return {parameters.max_bytes, bytes_of_block, is_refined};
}

BlockUpdate BlockMesh::Impl::update(const BlockViewParameters& parameters) {
  BlockUpdate report;
  const bool is_same = parameters.view == last.view && parameters.max_bytes == last.max_bytes;
  if (is_same && !has_changed) return report;
  has_changed = false;
  last = parameters;
  ++updates;
  const std::span<const std::uint32_t> chosen = chooser.choose(parameters.view, limits(parameters));
  report.evaluated = chooser.evaluated();
  missing.clear();
  for (const std::uint32_t block : chosen) {
    wanted_at[block] = updates;
    if (!resident[block]) missing.push_back(graph.entry(block));
  }
  move_cut(chosen, report);
  view_error = 0;
  for (const BlockChooser::Candidate& wrong : chooser.wrong()) {
    if (!is_refined[wrong.block]) view_error = std::max(view_error, wrong.error);
  }
  drop_beyond(parameters.max_bytes, report);
  return report;
}

void BlockMesh::Impl::move_cut(std::span<const std::uint32_t> chosen, BlockUpdate& report) {
  std::vector<std::uint32_t> next(chosen.begin(), chosen.end());
  std::sort(next.begin(), next.end());
  std::vector<char> will_be(is_refined.size(), 0);
  std::erase_if(next, [&](std::uint32_t block) {
    const std::span<const std::uint32_t> needed = graph.dependencies(block);
    will_be[block] =
        resident[block] != nullptr &&
        std::all_of(needed.begin(), needed.end(), [&](std::uint32_t n) { return will_be[n] != 0; });
    return will_be[block] == 0;
  });
  for (const std::uint32_t block : next) report.refined += !is_refined[block];
  for (const std::uint32_t block : cut) report.coarsened += !will_be[block];
  if (report.refined + report.coarsened == 0) return;
  is_refined = std::move(will_be);
  cut = std::move(next);
  list_shown();
}

// The one that nobody wanted for longest goes first.
void BlockMesh::Impl::drop_beyond(std::size_t max_bytes, BlockUpdate& report) {
  if (resident_bytes <= max_bytes) return;
  std::vector<std::uint32_t> unwanted;
  for (std::uint32_t block = 0; block < resident.size(); ++block) {
    if (resident[block] && wanted_at[block] != updates) unwanted.push_back(block);
  }
  std::stable_sort(unwanted.begin(), unwanted.end(), [this](std::uint32_t a, std::uint32_t b) {
    return wanted_at[a] < wanted_at[b];
  });
  for (const std::uint32_t block : unwanted) {
    if (resident_bytes <= max_bytes) return;
    CREASE_ASSERT(!is_refined[block]);
    resident_bytes -= resident[block]->bytes();
    --resident_count;
    resident[block] = nullptr;
    report.dropped.push_back(graph.entry(block).id);
  }
}

// A group is shown unless the block that goes on with it is refined.
bool BlockMesh::Impl::is_shown(std::uint32_t block, std::uint32_t patch) const {
  const std::uint32_t finer = graph.next_finer(graph.entry(block).facts.band, patch);
  return finer == kNone || finer >= is_refined.size() || !is_refined[finer];
}

// Of what is shown or vanished: what the blocks that would go on from here say of their coarse
// ends.
LevelError BlockMesh::Impl::error_of_cut() const {
  LevelError error;
  const auto add = [&](std::uint32_t block) {
    if (!is_refined[block]) error = larger(error, graph.entry(block).facts.coarse);
  };
  for (const std::uint32_t block : graph.starts()) add(block);
  for (const std::uint32_t block : cut) {
    for (const std::uint32_t finer : graph.dependents(block)) add(finer);
  }
  return error;
}

void BlockMesh::Impl::list_shown() {
  shown.clear();
  shown_triangles = 0;
  for (const std::uint32_t block : cut) list_shown_of(block);
  for (const ShownRange& range : shown) shown_triangles += range.triangle_count();
  shown_error = error_of_cut();
}

void BlockMesh::Impl::list_shown_of(std::uint32_t block) {
  bool goes_on = false;
  for (const BlockGroup& group : resident[block]->groups()) {
    const bool shows = is_shown(block, group.patch);
    if (shows && goes_on) {
      ShownRange& range = shown.back();
      range.sn.count += group.sn.count;
      range.fn.count += group.fn.count;
      range.nsn.count += group.nsn.count;
    } else if (shows) {
      shown.push_back({resident[block].get(), group.sn, group.fn, group.nsn});
    }
    goes_on = shows;
  }
}

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

std::span<const BlockEntry> BlockMesh::missing() const {
  return impl_->missing;
}

std::vector<BlockEntry> BlockMesh::missing_for(const BlockViewParameters& parameters) const {
  std::vector<BlockEntry> missing;
  BlockChooser chooser(impl_->graph, impl_->schema->facts.grid);
  for (const std::uint32_t block : chooser.choose(parameters.view, impl_->limits(parameters))) {
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
  place = std::move(block);
  impl_->has_changed = true;
}

std::span<const ShownRange> BlockMesh::shown() const {
  return impl_->shown;
}

std::size_t BlockMesh::triangle_count() const {
  return impl_->shown_triangles;
}

LevelError BlockMesh::error() const {
  return impl_->shown_error;
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
  return index_of(id) < impl_->is_refined.size() && impl_->is_refined[index_of(id)] != 0;
}

const ModelFacts& BlockMesh::facts() const {
  return impl_->schema->facts;
}

std::span<const Material> BlockMesh::materials() const {
  return impl_->schema->materials;
}

Mesh BlockMesh::extract() const {
  std::vector<codec::PatchMesh> ends;
  std::vector<codec::EndPiece> pieces;
  std::vector<codec::PlacedTriangle> triangles;
  std::vector<Vec3i> positions;
  std::vector<std::vector<std::uint32_t>> vertices(impl_->cut.size());
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_name;
  for (std::uint32_t i = 0; i < impl_->cut.size(); ++i) {
    const std::uint32_t block = impl_->cut[i];
    const codec::FineEnd& end = impl_->resident[block]->data().end;
    vertices[i].assign(end.names.size(), kNone);
    for (std::uint32_t t = 0; t < end.labels.size(); ++t) {
      if (!impl_->is_shown(block, end.labels[t])) continue;
      triangles.push_back({i, t});
      for (const std::uint32_t v : end.mesh.triangles[t]) {
        if (vertices[i][v] != kNone) continue;
        const codec::VertexName& name = end.names[v];
        const auto [at, is_new] =
            vertex_of_name.try_emplace(std::uint64_t(name.block) << 32 | name.vertex,
                                       static_cast<std::uint32_t>(positions.size()));
        if (is_new) positions.push_back(end.mesh.positions[v]);
        vertices[i][v] = at->second;
      }
    }
    ends.push_back(whole_end(impl_->resident[block]->data()));
  }
  for (std::uint32_t i = 0; i < ends.size(); ++i) pieces.push_back({&ends[i], vertices[i]});
  ModelSchema schema = *impl_->schema;
  schema.parts = impl_->part_names;
  codec::LayerPools layers(schema);
  return codec::join_ends(schema, pieces, triangles, positions, layers.pools());
}

}  // namespace crease
