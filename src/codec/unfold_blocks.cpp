#include "codec/unfold_blocks.h"

#include "base/assert.h"
#include "crease/ids.h"

#include <numeric>
#include <utility>

namespace crease::codec {

void BlockUnfolder::add(const BlockEntry& entry, DecodedBlock decoded, const Start& start) {
  UnfoldedBlock block;
  block.band = entry.facts.band;
  block.coarse = entry.facts.coarse;
  block.fine = entry.facts.fine;
  block.coarse_vertex_count = static_cast<std::uint32_t>(start.names.size());
  block.end = std::move(decoded.end.mesh);
  block.splits = std::move(decoded.splits);

  block.vertices.reserve(block.end.positions.size());
  for (const VertexName& name : start.names) {
    block.vertices.push_back(slot_of(name));
  }
  while (block.vertices.size() < block.end.positions.size()) {
    const VertexName& name = decoded.end.names[block.vertices.size()];
    const bool is_own = name.block == index_of(entry.id);
    block.vertices.push_back(is_own ? slot_count_++ : slot_of(name));
  }

  block.triangles.reserve(block.end.triangles.size());
  block.coarse_values.resize(block.end.values.size());
  for (auto& values : block.coarse_values) values.reserve(3 * start.sources.size());
  for (const TriangleSource& source : start.sources) {
    const UnfoldedBlock& from = blocks_[source.end];
    block.triangles.push_back(from.triangles[source.triangle]);
    block.coarse_derived.push_back(from.end.derived[source.triangle]);
    for (std::size_t l = 0; l < block.coarse_values.size(); ++l) {
      const auto first = from.end.values[l].begin() + 3 * std::ptrdiff_t(source.triangle);
      block.coarse_values[l].insert(block.coarse_values[l].end(), first, first + 3);
    }
  }
  while (block.triangles.size() < block.end.triangles.size()) {
    block.triangles.push_back(triangle_count_++);
  }

  block_of_id_.resize(index_of(entry.id) + 1, kNone);
  block_of_id_[index_of(entry.id)] = static_cast<std::uint32_t>(blocks_.size());
  blocks_.push_back(std::move(block));
}

void BlockUnfolder::add_alone(const BlockFacts& facts, PatchMesh end, std::vector<Split> splits,
                              const CoarseEnd& start) {
  UnfoldedBlock block;
  block.band = facts.band;
  block.coarse = facts.coarse;
  block.fine = facts.fine;
  block.coarse_vertex_count = static_cast<std::uint32_t>(start.names.size());
  block.coarse_derived = start.mesh.derived;
  block.coarse_values = start.mesh.values;
  block.end = std::move(end);
  block.coarse_values.resize(block.end.values.size());
  block.splits = std::move(splits);
  slot_count_ = static_cast<std::uint32_t>(block.end.positions.size());
  triangle_count_ = static_cast<std::uint32_t>(block.end.triangles.size());
  block.vertices.resize(slot_count_);
  std::iota(block.vertices.begin(), block.vertices.end(), 0);
  block.triangles.resize(triangle_count_);
  std::iota(block.triangles.begin(), block.triangles.end(), 0);
  blocks_.push_back(std::move(block));
}

bool BlockUnfolder::has(const VertexName& name) const {
  if (name.block >= block_of_id_.size() || block_of_id_[name.block] == kNone) return false;
  return name.vertex < blocks_[block_of_id_[name.block]].vertices.size();
}

std::uint32_t BlockUnfolder::slot_of(const VertexName& name) const {
  return blocks_[block_of_id_[name.block]].vertices[name.vertex];
}

}  // namespace crease::codec
