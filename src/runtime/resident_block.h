// Blocks in memory: decoded from the fine ends of the coarser ones, and laid out for drawing.
#pragma once

#include "codec/model_schema.h"
#include "crease/block_mesh.h"
#include "runtime/kept_end.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace crease {

// One of the three parts of all triangles of a block, group by group.
struct BlockPart {
  std::vector<std::uint32_t> indices;
  std::vector<Vec3f> normals;
  std::vector<std::uint32_t> materials;
  std::vector<std::array<float, 4>> colors;
  std::vector<std::array<float, 2>> texcoords;
  PackedIndices<> parts;  // of the model, per triangle; or empty where it has one at most

  std::size_t bytes() const;
};

struct ResidentBlock::Data {
  BlockEntry entry;
  std::shared_ptr<const codec::ModelSchema> schema;
  KeptEnd end;
  // What it takes to go back to its coarse end (runtime/block_hierarchy.h). The roots are the first
  // vertices: those of the coarse end, then those that no triangle has there. Their names are those
  // before any split.
  KeptSplits splits;
  KeptNames root_names;
  std::uint32_t coarse_triangles = 0;  // of the coarse end; the first ones of `end`
  std::vector<BlockGroup> groups;
  // Of the draw list, per vertex of `end`.
  PackedIndices<> position_of_vertex;
  std::vector<Vec3f> positions, vertex_normals;  // as in DrawList: SN vertices first
  BlockPart sn, fn, nsn;
  std::size_t bytes = 0;
};

inline PartId part_in(const BlockPart& part, std::size_t triangle) {
  return PartId{part.parts.size() == 0 ? 0 : part.parts[triangle]};
}

struct BlockDecodeJob::Data {
  BlockEntry entry;
  std::shared_ptr<const codec::ModelSchema> schema;
  std::vector<ResidentBlockPtr> needed;  // ascending
};

// What a block takes at most.
std::size_t resident_bytes_of(const BlockFacts& facts, const codec::ModelSchema& schema);

// What a block starts from, with its values: the triangles of `needed`, those that it needs, that
// are of its patch. Those of other bands are passed over.
codec::CoarseEnd coarse_end_of(std::span<const ResidentBlockPtr> needed, const BlockFacts& facts);

// Fills what is for drawing from the fine end, which has its values.
void lay_out_for_drawing(const codec::FineEnd& end, ResidentBlock::Data& block);

}  // namespace crease
