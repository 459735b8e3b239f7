// Mesh + ContractionSequence -> the plans of blocks.
#pragma once

#include "codec/encode_block.h"
#include "codec/layer_values.h"
#include "crease/contraction.h"
#include "crease/mesh.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace crease {

// Plans of one band, by patch; the vertices and triangles of each by their input ids.
struct BandPlans {
  struct Errors {
    LevelError coarse, fine;  // the largest at either end
  };
  // The plan of patch p.
  codec::BlockPlan plan(std::size_t p) const;

  // Of its values only which they are: bands stay in memory together, and a value is four times as
  // large. Per layer, 3 a triangle, into `values`, which all bands share.
  std::vector<codec::BlockPlan> plans;
  std::vector<std::vector<std::vector<AttributeId>>> value_ids;
  std::shared_ptr<const std::vector<std::vector<codec::CodedValue>>> values;
  std::vector<Errors> errors;
  std::vector<std::vector<std::uint32_t>> vertex_ids, triangle_ids;
  // Of those vertices, which stand at the coarse end without a triangle of their patch there.
  std::vector<std::vector<std::uint32_t>> roots;
};

// What a file says of the mesh's layers.
std::vector<LayerSchema> schema_of(const Mesh& mesh, std::span<const LayerCoding> codings);

// How values of the mesh's layers become integers, and the categories: material and part as one.
// `codings`: one a layer, which the mesh and the sequence are snapped to (snap_attributes.h).
codec::BlockCoding block_coding(const Mesh& mesh, std::span<const LayerCoding> codings);

// Coarsest first: the base mesh, which is one plan without steps, then band after band down to the
// input. `sequence` must have its bands. Time linear in the triangles of all bands.
std::vector<BandPlans> plan_blocks(const Mesh& snapped, const ContractionSequence& sequence,
                                   std::span<const LayerCoding> codings);

}  // namespace crease
