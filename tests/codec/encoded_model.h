// Models as files in memory, for the tests of the codec.
#pragma once

#include "codec/byte_sink.h"
#include "crease/file.h"
#include "crease/simplify.h"
#include "pipeline/encode_model.h"
#include "pipeline/join_equal_values.h"
#include "pipeline/snap_attributes.h"
#include "support/random_contractions.h"

#include <doctest/doctest.h>

#include <span>
#include <utility>
#include <vector>

namespace crease {

struct EncodedCase {
  Mesh mesh;  // snapped
  ContractionSequence sequence;
  std::vector<std::byte> bytes;
};

inline EncodedCase encoded_case(Mesh mesh, ContractionSequence sequence,
                                const std::vector<LayerCoding>& codings) {
  snap_to_codings(mesh, codings);
  join_equal_values(sequence, mesh, codings);
  MemorySink sink;
  const Result<EncodedModel> encoded = encode_model(mesh, sequence, codings, sink);
  REQUIRE_MESSAGE(encoded.ok(), (encoded.ok() ? "" : encoded.failure().message));
  return {std::move(mesh), std::move(sequence), sink.take()};
}

// As a build does it.
inline EncodedCase simplified_case(Mesh mesh, std::uint32_t patch_triangles, int bits,
                                   const AttributePrecision& precision,
                                   Placement placement = Placement::Optimal) {
  const Grid grid = make_grid(mesh, {.length = 0, .bits = bits});
  snap(mesh, grid);
  const std::vector<LayerCoding> codings = codings_of(mesh, precision);
  snap_to_codings(mesh, codings);
  Result<ContractionSequence> sequence = simplify(mesh, grid,
                                                  {.placement = placement,
                                                   .patch_triangles = patch_triangles,
                                                   .threads = 1,
                                                   .record_bands = true,
                                                   .progress = {}});
  REQUIRE(sequence.ok());
  snap_new_values(*sequence, mesh, codings);
  return encoded_case(std::move(mesh), *std::move(sequence), codings);
}

inline constexpr AttributePrecision kCoarsePrecision{
    .normal_bits = 10, .texcoord_bits = 12, .color_bits = 8};
inline constexpr AttributePrecision kExactPrecision{
    .normal_bits = kExactBits, .texcoord_bits = kExactBits, .color_bits = kExactBits};

// The whole sequence as one band of one patch.
inline void make_one_band(const Mesh& mesh, ContractionSequence& sequence) {
  Band band;
  band.contraction_count = std::uint32_t(sequence.contractions.size());
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) band.triangles.push_back(TriangleId{t});
  band.first_triangle = {0, std::uint32_t(mesh.triangle_count())};
  sequence.bands = {band};
  sequence.patch_of_contraction.assign(sequence.contractions.size(), 0);
}

inline bool has_isolated_vertex(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertex_count(), false);
  for (const Triangle& t : mesh.triangles) {
    for (VertexId v : t) used[index_of(v)] = true;
  }
  return std::find(used.begin(), used.end(), false) != used.end();
}

// A small one of every kind of attribute, in two blocks.
inline EncodedCase small_case(std::uint64_t seed = 5) {
  for (;; ++seed) {
    Mesh mesh = random_complex(seed, 12, 24);
    if (has_isolated_vertex(mesh)) continue;
    const Grid grid = make_grid(mesh, {.length = 0, .bits = 10});
    snap(mesh, grid);
    const std::vector<LayerCoding> codings = codings_of(mesh, kCoarsePrecision);
    snap_to_codings(mesh, codings);
    ContractionSequence sequence = random_contractions(mesh, grid, {.seed = seed});
    snap_new_values(sequence, mesh, codings);
    make_one_band(mesh, sequence);
    return encoded_case(std::move(mesh), std::move(sequence), codings);
  }
}

// The bytes must outlive it.
inline BlockFile opened(std::span<const std::byte> bytes) {
  Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  return *std::move(file);
}

}  // namespace crease
