#include "codec/model_schema.h"

#include "codec/lattices.h"
#include "codec/layer_values.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace crease::codec {

Result<ModelSchema> read_schema(const BlockFile& file) {
  ModelSchema schema;
  schema.facts = file.facts();
  Result<std::vector<std::byte>> tables = file.read_tables();
  if (!tables.ok()) return tables.failure();
  Result<std::vector<LayerCoding>> codings = decode_codings(schema.facts.layers, *tables);
  if (!codings.ok()) return codings.failure();
  schema.codings = *std::move(codings);
  Result<std::vector<Material>> materials = file.read_materials();
  if (!materials.ok()) return materials.failure();
  schema.materials = *std::move(materials);
  const std::uint64_t part_count = file.head().part_count;
  if (part_count * std::max<std::size_t>(1, schema.materials.size()) >> 32 != 0) {
    return fail(Error::BadFormat, "more materials and parts than triangles can tell apart");
  }
  schema.coding = block_coding(schema.facts.layers, schema.codings, schema.materials.size(),
                               static_cast<std::size_t>(part_count));
  return schema;
}

Failure bad_block(BlockId id, const char* what) {
  return fail(Error::BadFormat, "block " + std::to_string(index_of(id)) + ": " + what);
}

namespace {

// As the head says: no coordinate is 2^grid_bits or more, either way.
bool is_on_grid(const DecodedBlock& block, int grid_bits) {
  const std::int64_t limit = std::int64_t(1) << grid_bits;
  const auto is_inside = [limit](const Vec3i& p) {
    return std::max({std::abs(std::int64_t(p.x)), std::abs(std::int64_t(p.y)),
                     std::abs(std::int64_t(p.z))}) < limit;
  };
  return std::all_of(block.end.mesh.positions.begin(), block.end.mesh.positions.end(), is_inside) &&
         std::all_of(block.splits.begin(), block.splits.end(),
                     [&](const Split& split) { return is_inside(split.parent_position); });
}

}  // namespace

Result<DecodedBlock> decode_block_of(const ModelSchema& schema, const BlockEntry& entry,
                                     std::span<const std::byte> payload, CoarseEnd start,
                                     StreamBits* bits) {
  const BlockFacts& facts = entry.facts;
  if (start.mesh.triangles.size() != facts.triangles_coarse) {
    return bad_block(entry.id, "it starts from other triangles than it says");
  }
  Result<DecodedBlock> block =
      decode_block(payload, static_cast<std::uint32_t>(index_of(entry.id)), schema.coding,
                   {facts.vertices, facts.triangles_fine}, std::move(start), bits);
  if (!block.ok()) return block.failure();
  if (block->end.mesh.positions.size() != facts.vertices ||
      block->end.mesh.triangles.size() != facts.triangles_fine ||
      block->splits.size() != facts.splits) {
    return bad_block(entry.id, "it holds other counts than it says");
  }
  if (!is_on_grid(*block, schema.facts.grid_bits)) {
    return bad_block(entry.id, "a vertex lies outside of the grid");
  }
  return block;
}

}  // namespace crease::codec
