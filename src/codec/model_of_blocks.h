// Unfolded blocks -> DecodedModel: the finest mesh and the contractions, finest first.
#pragma once

#include "codec/join_ends.h"
#include "codec/model_schema.h"
#include "codec/rejoin_attributes.h"
#include "codec/unfold_blocks.h"
#include "crease/decode_model.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace crease::codec {

using ForEach = std::function<void(std::size_t, const std::function<void(std::size_t)>&)>;

class ModelOfBlocks {
 public:
  ModelOfBlocks(const ModelSchema& schema, const BlockUnfolder& unfolder);

  // The mesh, and the contractions of as many of the finest bands. Order and cost of each block's
  // are worked out by `for_each`.
  void fill(DecodedModel& model, std::size_t contracted_bands, const ForEach& for_each);
  // Afterwards, per contraction: what it adds to the errors at its block's fine end, as much as
  // witnesses of the finest mesh and the block's quadrics tell.
  std::span<const LevelError> own_errors() const { return own_errors_; }

 private:
  struct Pending;  // a contraction of the present band
  void fill_mesh(Mesh& mesh);
  void find_witnesses(const Mesh& mesh);
  void fill_sequence(const Mesh& mesh, std::size_t contracted_bands, const ForEach& for_each,
                     ContractionSequence& sequence);
  void contract_band(std::span<const UnfoldedBlock> blocks, AttributeRejoiner& rejoiner,
                     const ForEach& for_each, ContractionSequence& sequence);
  void append(const UnfoldedBlock& block, const OrderedContraction& contraction,
              std::span<const AttributeChange> changes, std::span<const TriangleId> derived,
              ContractionSequence& sequence);

  const ModelSchema& schema_;
  std::span<const UnfoldedBlock> blocks_;
  std::uint32_t slot_count_, triangle_count_;
  LayerPools layers_;
  std::vector<Vec3i> positions_;  // per slot
  std::vector<LevelError> error_of_slot_;
  std::vector<LevelError> own_errors_;
  Witnesses witnesses_;  // the finest mesh's, by slots and numbers
};

}  // namespace crease::codec
