// Unfolded blocks -> DecodedModel: the finest mesh and the contractions, finest first.
#pragma once

#include "codec/layer_values.h"
#include "codec/rejoin_attributes.h"
#include "codec/unfold_blocks.h"
#include "codec/value_pool.h"
#include "crease/decode_model.h"
#include "mesh/corners_around.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace crease::codec {

using ForEach = std::function<void(std::size_t, const std::function<void(std::size_t)>&)>;

class ModelOfBlocks {
 public:
  ModelOfBlocks(const ModelFacts& facts, std::span<const LayerCoding> codings,
                const BlockCoding& coding, const BlockUnfolder& unfolder);

  // The mesh but for its names, and the sequence but for its grid: the contractions of as many of
  // the finest bands. Order and cost of each block's are worked out by `for_each`.
  void fill(DecodedModel& model, std::size_t contracted_bands, const ForEach& for_each);

 private:
  struct Pending;  // a contraction of the present band
  struct Place {   // of a triangle at its finest
    std::uint32_t block = 0, triangle = 0;
  };
  void fill_mesh(Mesh& mesh);
  void fill_layer(std::span<const Place> places, std::size_t l, const Mesh& mesh,
                  const CornersAround& around, AttributeLayer& layer);
  void fill_sequence(ContractionSequence& sequence, std::size_t contracted_bands,
                     const ForEach& for_each);
  void contract_band(std::span<const UnfoldedBlock> blocks, AttributeRejoiner& rejoiner,
                     const ForEach& for_each, ContractionSequence& sequence);
  void append(const UnfoldedBlock& block, const OrderedContraction& contraction,
              CornerChanges& changes, float share, ContractionSequence& sequence);
  std::uint32_t geometric_value(const Triangle& triangle, ValuePool& pool) const;

  const ModelFacts& facts_;
  const BlockCoding& coding_;
  std::span<const UnfoldedBlock> blocks_;
  std::uint32_t slot_count_, triangle_count_;
  std::vector<LayerValues> values_;                    // per layer
  std::vector<ValuePool> pools_;                       // per layer
  std::vector<std::vector<std::uint32_t>> of_corner_;  // per layer, of the finest mesh
  std::vector<Vec3i> positions_;                       // per slot
  std::vector<LevelError> error_of_slot_;
};

}  // namespace crease::codec
