#include "runtime/resident_block.h"

#include "mesh/painted_layer.h"

#include <algorithm>
#include <utility>

namespace crease {

namespace {

template <typename T>
std::size_t bytes_of_vector(const std::vector<T>& all) {
  return all.capacity() * sizeof(T);
}

std::size_t bytes_of_end(const codec::FineEnd& end) {
  const codec::PatchMesh& mesh = end.mesh;
  std::size_t bytes = bytes_of_vector(mesh.positions) + bytes_of_vector(mesh.triangles) +
                      bytes_of_vector(mesh.category) + bytes_of_vector(mesh.derived) +
                      bytes_of_vector(end.names) + bytes_of_vector(end.labels);
  return bytes;
}

std::size_t bytes_of_values(const std::vector<codec::CompactValues>& layers) {
  std::size_t bytes = bytes_of_vector(layers);
  for (const codec::CompactValues& layer : layers) {
    bytes += bytes_of_vector(layer.values) + bytes_of_vector(layer.of_corner);
  }
  return bytes;
}

// Of what stays, room that a vector grew by and did not need goes.
void shrink(codec::FineEnd& end) {
  end.mesh.positions.shrink_to_fit();
  end.mesh.triangles.shrink_to_fit();
  end.mesh.category.shrink_to_fit();
  end.mesh.derived.shrink_to_fit();
  end.names.shrink_to_fit();
  end.labels.shrink_to_fit();
}

constexpr std::size_t kBytesOfBlock = 1024;  // beside its arrays
constexpr std::size_t kBytesOfGroup = sizeof(BlockGroup);

}  // namespace

std::size_t BlockPart::bytes() const {
  return bytes_of_vector(indices) + bytes_of_vector(normals) + bytes_of_vector(materials) +
         bytes_of_vector(colors) + bytes_of_vector(texcoords);
}

std::size_t resident_bytes_of(const BlockFacts& facts, const codec::ModelSchema& schema) {
  const bool has_colors =
      std::any_of(schema.facts.layers.begin(), schema.facts.layers.end(),
                  [](const LayerSchema& layer) { return layer.role == AttributeRole::Color; });
  const bool has_texcoords = painted_layer(schema.facts.layers, schema.materials) != kNone;
  const std::size_t layers = schema.facts.layers.size();
  const std::size_t of_vertex =
      sizeof(Vec3i) + sizeof(codec::VertexName) + sizeof(std::uint32_t) + 2 * sizeof(Vec3f) +
      std::max(sizeof(codec::Split), sizeof(codec::VertexName));  // a root or made by a split
  // Corners, category, derived, label; values, each of its own; a group of its own; indices,
  // normals, material.
  const std::size_t of_triangle =
      sizeof(codec::Corners) + 9 + 3 * layers * (sizeof(codec::CodedValue) + 4) + kBytesOfGroup +
      12 + 3 * sizeof(Vec3f) + 4 + (has_colors ? 3 * sizeof(std::array<float, 4>) : 0) +
      (has_texcoords ? 3 * sizeof(std::array<float, 2>) : 0);
  return kBytesOfBlock + layers * sizeof(codec::CompactValues) + of_vertex * facts.vertices +
         of_triangle * facts.triangles_fine;
}

ResidentBlock::ResidentBlock(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
ResidentBlock::~ResidentBlock() = default;

BlockId ResidentBlock::id() const {
  return data_->entry.id;
}

const BlockFacts& ResidentBlock::facts() const {
  return data_->entry.facts;
}

std::span<const BlockGroup> ResidentBlock::groups() const {
  return data_->groups;
}

std::size_t ResidentBlock::bytes() const {
  return data_->bytes;
}

DrawList ResidentBlock::draw_list() const {
  const auto part = [](const BlockPart& p) -> DrawPart {
    return {p.indices, p.normals, p.materials, p.colors, p.texcoords};
  };
  DrawList list;
  list.origin = data_->schema->facts.grid.origin;
  list.positions = data_->positions;
  list.vertex_normals = data_->vertex_normals;
  list.sn = part(data_->sn);
  list.fn = part(data_->fn);
  list.nsn = part(data_->nsn);
  list.materials = data_->schema->materials;
  return list;
}

BlockDecodeJob::BlockDecodeJob(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
BlockDecodeJob::~BlockDecodeJob() = default;
BlockDecodeJob::BlockDecodeJob(BlockDecodeJob&&) noexcept = default;

const BlockEntry& BlockDecodeJob::entry() const {
  return data_->entry;
}

namespace {

// Names that the block did not make are those of blocks that it needs.
bool names_are_known(const codec::FineEnd& end, std::size_t first, BlockId id,
                     std::span<const ResidentBlockPtr> needed) {
  for (std::size_t v = first; v < end.names.size(); ++v) {
    const codec::VertexName& name = end.names[v];
    if (name.block == index_of(id)) continue;
    const auto maker = std::find_if(needed.begin(), needed.end(), [&](const ResidentBlockPtr& b) {
      return index_of(b->id()) == name.block;
    });
    if (maker == needed.end() || name.vertex >= (*maker)->data().end.names.size()) return false;
  }
  return true;
}

// The start's sources count among the blocks.
void fill_values(std::span<const ResidentBlock::Data* const> blocks, codec::CoarseEnd& start) {
  const std::size_t layers = blocks.empty() ? 0 : blocks[0]->values.size();
  start.mesh.values.resize(layers);
  for (std::size_t l = 0; l < layers; ++l) {
    start.mesh.values[l].reserve(3 * start.sources.size());
    for (const codec::TriangleSource& source : start.sources) {
      const codec::CompactValues& values = blocks[source.end]->values[l];
      for (std::size_t c = 0; c < 3; ++c) {
        start.mesh.values[l].push_back(values.at(3 * std::size_t(source.triangle) + c));
      }
    }
  }
}

}  // namespace

codec::CoarseEnd coarse_end_of(std::span<const ResidentBlockPtr> needed, const BlockFacts& facts) {
  std::vector<const ResidentBlock::Data*> blocks;
  std::vector<const codec::FineEnd*> ends;
  for (const ResidentBlockPtr& block : needed) {
    if (block->data().entry.facts.band != facts.band + 1) continue;
    blocks.push_back(&block->data());
    ends.push_back(&block->data().end);
  }
  codec::CoarseEnd start = codec::coarse_end_of(ends, facts.patch);
  fill_values(blocks, start);
  return start;
}

codec::PatchMesh whole_end(const ResidentBlock::Data& block) {
  codec::PatchMesh mesh = block.end.mesh;
  for (const codec::CompactValues& layer : block.values) {
    std::vector<codec::CodedValue>& values = mesh.values.emplace_back();
    values.reserve(layer.of_corner.size());
    for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
      values.push_back(layer.at(corner));
    }
  }
  return mesh;
}

Result<ResidentBlockPtr> BlockDecodeJob::run(std::span<const std::byte> payload) const {
  if (Status status = check_payload(data_->entry, payload); !status.ok()) return status.failure();
  const BlockFacts& facts = data_->entry.facts;
  if (codec::decoded_bytes({facts.vertices, facts.triangles_fine},
                           data_->schema->facts.layers.size()) > facts.decoded_bytes) {
    return codec::bad_block(data_->entry.id, "it takes more memory than it says");
  }
  codec::CoarseEnd start = coarse_end_of(data_->needed, facts);
  std::vector<codec::VertexName> names = start.names;
  const std::size_t known = names.size(), coarse_triangles = start.sources.size();
  Result<codec::DecodedBlock> decoded =
      codec::decode_block_of(*data_->schema, data_->entry, payload, std::move(start));
  if (!decoded.ok()) return decoded.failure();
  if (!names_are_known(decoded->end, known, data_->entry.id, data_->needed)) {
    return codec::bad_block(data_->entry.id, "it names a vertex that no block has that it needs");
  }
  auto block = std::make_unique<ResidentBlock::Data>();
  block->entry = data_->entry;
  block->schema = data_->schema;
  block->end = std::move(decoded->end);
  block->splits = std::move(decoded->splits);
  block->coarse_triangles = static_cast<std::uint32_t>(coarse_triangles);
  const std::size_t roots = block->end.names.size() - block->splits.size();
  names.insert(names.end(), block->end.names.begin() + std::ptrdiff_t(known),
               block->end.names.begin() + std::ptrdiff_t(roots));
  block->root_names = std::move(names);
  lay_out_for_drawing(*block);
  for (const auto& values : block->end.mesh.values) {
    block->values.push_back(codec::compacted(values));
  }
  block->end.mesh.values = {};
  shrink(block->end);
  block->splits.shrink_to_fit();
  block->root_names.shrink_to_fit();
  block->bytes = kBytesOfBlock + bytes_of_end(block->end) + bytes_of_values(block->values) +
                 bytes_of_vector(block->splits) + bytes_of_vector(block->root_names) +
                 bytes_of_vector(block->groups) + bytes_of_vector(block->position_of_vertex) +
                 bytes_of_vector(block->positions) + bytes_of_vector(block->vertex_normals) +
                 block->sn.bytes() + block->fn.bytes() + block->nsn.bytes();
  return std::make_shared<const ResidentBlock>(std::move(block));
}

}  // namespace crease
