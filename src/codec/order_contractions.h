// In which order the vertices of a block are contracted, and how wrong each is. A block says which,
// not when: both follow from what a contraction does to the shape, nearly as in the simplifier.
#pragma once

#include "codec/layer_values.h"
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
  // What it adds to the errors that its vertex has at the fine end, as the simplifier counts them;
  // lengths in grid units.
  LevelError own;
  float far = 0;  // of witnesses around it, the farthest that counts; grid units
};

struct ContractionOrder {
  std::vector<OrderedContraction> contractions;
  std::vector<WedgeValues> wedges;  // per layer
};

// Cheapest first, children before their parents, the same in any subset of blocks. The cost is that
// of quadrics from the block's fine end: squared distances of where the parent stands from the
// planes of what it stands for, by area, and from borders and creases, by squared length; how far
// attributes are from those of what their wedges stand for; and how far faces turn. `values`: one a
// layer. `witnesses`: by the model's triangles, of which it moves the block's; they are where the
// blocks of finer bands have left them. Time O(splits * triangles around a vertex).
ContractionOrder order_contractions(const UnfoldedBlock& block, const BlockCoding& coding,
                                    std::span<const LayerSchema> layers,
                                    std::span<const LayerValues> values, Witnesses& witnesses);

}  // namespace crease::codec
