#include "codec/model_schema.h"

#include "codec/container.h"

#include "codec/lattices.h"
#include "codec/layer_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
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
  if (file.head().version < format::kVersionWithRates) schema.coding.rates = kRatesBefore;
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

// Floats that are kept bit by bit may be anything. What derived triangles say of normals nobody
// looks at.
bool has_finite_values(const ModelSchema& schema, const PatchMesh& mesh) {
  for (std::size_t l = 0; l < schema.codings.size(); ++l) {
    if (schema.codings[l].kind != LayerCoding::Kind::Exact) continue;
    const bool is_normal = schema.facts.layers[l].role == AttributeRole::Normal;
    const std::size_t dimension = schema.facts.layers[l].dimension;
    for (std::size_t corner = 0; corner < mesh.values[l].size(); ++corner) {
      if (is_normal && !mesh.derived.empty() && mesh.derived[corner / 3] != 0) continue;
      for (std::size_t k = 0; k < dimension; ++k) {
        if (!std::isfinite(std::bit_cast<float>(mesh.values[l][corner][k]))) return false;
      }
    }
  }
  return true;
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
  if (!has_finite_values(schema, block->end.mesh)) {
    return bad_block(entry.id, "a value of an attribute is not finite");
  }
  return block;
}

}  // namespace crease::codec
