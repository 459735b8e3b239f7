#include "runtime/resident_block.h"

#include "mesh/drawn_texcoords.h"
#include "runtime/group_by_place.h"

#include <algorithm>
#include <utility>

namespace crease {

namespace {

template <typename T>
std::size_t bytes_of_vector(const std::vector<T>& all) {
  return all.capacity() * sizeof(T);
}

constexpr std::size_t kBytesOfArray = 64;  // that is packed, at least
constexpr std::size_t kBytesOfBlock = sizeof(ResidentBlock::Data) + 1024;  // beside its arrays
constexpr std::size_t kBytesOfGroup = sizeof(BlockGroup);

// Each patch has some of its own.
std::size_t most_groups(const BlockFacts& facts, const ModelFacts& model) {
  const bool is_finest = facts.band == 0;
  const std::size_t patches = is_finest ? 1 : model.bands[facts.band - 1u].patches;
  return std::min<std::size_t>(facts.triangles_fine,
                               patches + facts.triangles_fine / (kGroupTriangles / 2));
}

// Of one value, as bits.
std::size_t most_bits(const codec::BlockLayer& layer) {
  return layer.octahedral_bits > 0 ? 2 * std::size_t(layer.octahedral_bits)
                                   : 32 * std::size_t(layer.dimension);
}

}  // namespace

std::size_t BlockPart::bytes() const {
  return bytes_of_vector(indices) + bytes_of_vector(normals) + bytes_of_vector(materials) +
         bytes_of_vector(colors) + bytes_of_vector(texcoords) + parts.bytes();
}

std::size_t resident_bytes_of(const BlockFacts& facts, const codec::ModelSchema& schema) {
  const bool has_colors =
      std::any_of(schema.facts.layers.begin(), schema.facts.layers.end(),
                  [](const LayerSchema& layer) { return layer.role == AttributeRole::Color; });
  const bool has_texcoords = drawn_texcoords(schema.facts.layers) != kNone;
  const std::size_t layers = schema.facts.layers.size();
  const std::size_t vertex_bits = bits_for(facts.vertices);
  const std::size_t of_vertex =
      sizeof(Vec3i) + sizeof(codec::VertexName) + 2 * sizeof(Vec3f) +
      std::max(sizeof(codec::Split), sizeof(codec::VertexName));  // a root or made by a split
  // Corners, derived; label and category, each of its own; values likewise.
  std::size_t bits_of_triangle = 3 * vertex_bits + 1 + 2 * (32 + bits_for(facts.triangles_fine)) +
                                 bits_for(schema.coding.part_count);
  for (const codec::BlockLayer& layer : schema.coding.layers) {
    bits_of_triangle += 3 * (most_bits(layer) + bits_for(3 * std::size_t(facts.triangles_fine)));
  }
  // Indices, normals, material.
  const std::size_t of_triangle = 12 + 3 * sizeof(Vec3f) + (schema.materials.empty() ? 0 : 4) +
                                  (has_colors ? 3 * sizeof(std::array<float, 4>) : 0) +
                                  (has_texcoords ? 3 * sizeof(std::array<float, 2>) : 0);
  return kBytesOfBlock + layers * (sizeof(codec::RepeatedRecords<4>) + kBytesOfArray) +
         kBytesOfGroup * most_groups(facts, schema.facts) +
         (of_vertex + vertex_bits / 8 + 1) * facts.vertices +
         (of_triangle + bits_of_triangle / 8 + 1) * facts.triangles_fine;
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

PartId ResidentBlock::part_of(TriangleKind kind, std::size_t triangle) const {
  const BlockPart& part = kind == TriangleKind::SN   ? data_->sn
                          : kind == TriangleKind::FN ? data_->fn
                                                     : data_->nsn;
  return part_in(part, triangle);
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
    if (maker == needed.end() || name.vertex >= (*maker)->data().end.vertex_count()) return false;
  }
  return true;
}

// The start's sources count among the blocks.
void fill_values(std::span<const ResidentBlock::Data* const> blocks, codec::CoarseEnd& start) {
  const std::size_t layers = blocks.empty() ? 0 : blocks[0]->end.layer_count();
  start.mesh.values.resize(layers);
  for (std::size_t l = 0; l < layers; ++l) {
    start.mesh.values[l].reserve(3 * start.sources.size());
    for (const codec::TriangleSource& source : start.sources) {
      for (std::size_t c = 0; c < 3; ++c) {
        start.mesh.values[l].push_back(
            blocks[source.end]->end.value(l, 3 * std::size_t(source.triangle) + c));
      }
    }
  }
}

}  // namespace

codec::CoarseEnd coarse_end_of(std::span<const ResidentBlockPtr> needed, const BlockFacts& facts) {
  std::vector<const ResidentBlock::Data*> blocks;
  std::vector<codec::FineEnd> ends;
  for (const ResidentBlockPtr& block : needed) {
    if (block->data().entry.facts.band != facts.band + 1) continue;
    blocks.push_back(&block->data());
    ends.push_back(block->data().end.unpacked_but_values());
  }
  std::vector<const codec::FineEnd*> pointers;
  for (const codec::FineEnd& end : ends) pointers.push_back(&end);
  codec::CoarseEnd start = codec::coarse_end_of(pointers, facts.patch);
  fill_values(blocks, start);
  return start;
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
  const codec::FineEnd& end = decoded->end;
  block->coarse_triangles = static_cast<std::uint32_t>(coarse_triangles);
  const std::size_t roots = end.names.size() - decoded->splits.size();
  names.insert(names.end(), end.names.begin() + std::ptrdiff_t(known),
               end.names.begin() + std::ptrdiff_t(roots));
  block->root_names = KeptNames(names);
  block->splits = KeptSplits(decoded->splits);
  block->end = KeptEnd(end);
  lay_out_for_drawing(end, *block);
  block->bytes = kBytesOfBlock + block->end.bytes() + block->splits.bytes() +
                 block->root_names.bytes() + bytes_of_vector(block->groups) +
                 block->position_of_vertex.bytes() + bytes_of_vector(block->positions) +
                 bytes_of_vector(block->vertex_normals) + block->sn.bytes() + block->fn.bytes() +
                 block->nsn.bytes();
  return std::make_shared<const ResidentBlock>(std::move(block));
}

}  // namespace crease
