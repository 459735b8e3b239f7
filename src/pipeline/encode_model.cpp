#include "pipeline/encode_model.h"

#include "codec/encode_container.h"
#include "codec/encode_lattices.h"
#include "pipeline/encode_blocks.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace crease {

namespace {

// Vertices without a triangle are in no block.
std::size_t used_vertex_count(const Mesh& mesh) {
  std::vector<char> is_used(mesh.vertex_count(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const VertexId v : t) is_used[index_of(v)] = 1;
  }
  return static_cast<std::size_t>(std::count(is_used.begin(), is_used.end(), 1));
}

std::uint8_t grid_bits(const Mesh& snapped, const ContractionSequence& sequence) {
  std::uint32_t all = 0;
  const auto see = [&all](const Vec3i& p) {
    for (int k = 0; k < 3; ++k) all |= static_cast<std::uint32_t>(std::abs(p[k]));
  };
  for (const Vec3d& p : snapped.positions) see(sequence.grid.nearest(p));
  for (const Contraction& c : sequence.contractions) see(c.position);
  return static_cast<std::uint8_t>(std::bit_width(all));
}

std::vector<BandFacts> band_facts(const Mesh& snapped, const ContractionSequence& sequence) {
  std::vector<BandFacts> bands;
  LevelError error;
  std::size_t next = 0;
  for (const Band& band : sequence.bands) {
    for (std::uint32_t i = 0; i < band.contraction_count; ++i, ++next) {
      const LevelError& e = sequence.contractions[next].error;
      error = {std::max(error.surface, e.surface), std::max(error.line, e.line),
               std::max(error.degrees, e.degrees), std::max(error.texture, e.texture)};
    }
    bands.push_back({static_cast<std::uint32_t>(band.patch_count()), band.contraction_count,
                     snapped.triangle_count(), error});
  }
  // What a band leaves is what the next one starts with.
  for (std::size_t b = 0; b + 1 < bands.size(); ++b) {
    bands[b].triangles_after = sequence.bands[b + 1].triangles.size();
  }
  return bands;
}

}  // namespace

Result<EncodedModel> encode_model(const Mesh& snapped, const ContractionSequence& sequence,
                                  std::span<const LayerCoding> codings, ByteSink& sink,
                                  const ProgressCallback& progress) {
  ContainerContent content;
  content.facts.grid = sequence.grid;
  content.facts.grid_bits = grid_bits(snapped, sequence);
  content.facts.vertex_count = used_vertex_count(snapped);
  content.facts.triangle_count = snapped.triangle_count();
  content.facts.up = snapped.up;
  content.facts.layers = schema_of(snapped, codings);
  content.facts.bands = band_facts(snapped, sequence);
  content.materials = snapped.materials;
  content.parts = snapped.parts;
  content.tables = encode_lattices(codings);
  content.images = snapped.images;

  Result<std::vector<CodedBlock>> coded = encode_blocks(plan_blocks(snapped, sequence, codings),
                                                        block_coding(snapped, codings), progress);
  if (!coded.ok()) return coded.failure();
  std::vector<CodedBlock>& blocks = *coded;
  if (!content.facts.bands.empty()) {
    content.facts.bands.back().triangles_after = blocks.front().facts.triangles_fine;
  }
  Result<ContainerWriter> writer = ContainerWriter::begin(sink, content, blocks.size());
  if (!writer.ok()) return writer.failure();
  for (CodedBlock& block : blocks) {
    if (Status status = writer->add(block.facts, block.dependencies, block.bytes); !status.ok()) {
      return status.failure();
    }
    block.bytes = {};
  }
  if (Status status = writer->finish(); !status.ok()) return status.failure();
  return EncodedModel{static_cast<std::uint32_t>(blocks.size())};
}

}  // namespace crease
