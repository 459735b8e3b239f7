// In which order the vertices of a block are contracted, and how wrong each is. A block says which,
// not when: both follow from what a contraction does to the shape, nearly as in the simplifier.
#pragma once

#include "codec/layer_values.h"
#include "codec/model_schema.h"
#include "codec/unfold_blocks.h"
#include "codec/wedge_quadrics.h"
#include "crease/contraction.h"
#include "hierarchy/witnesses.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

struct OrderedContraction {
  std::uint32_t split = 0;  // in UnfoldedBlock::splits
  double cost = 0;          // grid units^4; never below those before it
  LevelError own;           // what it adds to the errors that its vertex has at the fine end
  LevelError error;         // of its vertex
};

struct ContractionOrder {
  std::vector<OrderedContraction> contractions;
  std::vector<WedgeValues> wedges;  // per layer
  Placement placement = Placement::Endpoint;
};

// The errors of a contraction whose vertex has `base` at the fine end, as the simplifier adds them
// up, but none above those of the block's coarse end, `most`. `own`: what it adds.
LevelError added_error(const LevelError& base, const LevelError& own, const LevelError& most);

// Cheapest first, children before their parents, the same in any subset of blocks. The cost is that
// of quadrics from the block's fine end: squared distances of where the parent stands from the
// planes of what it stands for, by area, and from borders and creases, by squared length; how far
// attributes are from those of what their wedges stand for; and how far faces turn. `values`: one a
// layer. `error_of_slot`, in model units, is as the blocks of finer bands have left it. So are the
// witnesses, by the model's triangles, of which it moves the block's. Time O(splits * triangles
// around a vertex).
ContractionOrder order_contractions(const UnfoldedBlock& block, const ModelSchema& schema,
                                    std::span<const LayerValues> values,
                                    std::span<const LevelError> error_of_slot,
                                    Witnesses& witnesses);

}  // namespace crease::codec
