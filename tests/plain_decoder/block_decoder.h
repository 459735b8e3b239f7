// What the parts of a payload share: the mesh so far.
#pragma once

#include "plain_decoder/between.h"
#include "plain_decoder/block.h"
#include "plain_decoder/pair_odds.h"
#include "plain_decoder/places.h"

#include <optional>

namespace plain {

struct VertexState {
  std::size_t generation = 0;
  bool moved = false;
  std::optional<Miss> miss;
  std::uint32_t origin = 0;
};

// A block while it is decoded.
struct BlockState {
  BlockState(const BlockSchema& of, const Limits& most, std::uint32_t block)
      : schema(of), limits(most), number(block) {}

  const BlockSchema& schema;
  Limits limits;
  std::uint32_t number = 0;  // of the block
  std::uint32_t coarse_vertices = 0, coarse_triangles = 0;
  Surface surface;
  std::vector<VertexState> vertices;
  std::vector<bool> was_derived;           // per triangle of the coarse end
  std::vector<FloatVector> coarse_normal;  // per vertex of the coarse end
  std::vector<Point> coarse_place;         // likewise
  End end;                                 // what is known of the fine end
  std::vector<Split> splits;

  bool is_new(std::uint32_t t) const { return t >= coarse_triangles; }
  bool is_split_or_root(std::uint32_t v) const {
    return v >= coarse_vertices || vertices[v].generation > 0;
  }
};

// The parts of a payload, in their order.
void read_roots(RangeDecoder& in, BlockState& block);
void read_splits(RangeDecoder& in, BlockState& block);
void read_categories(RangeDecoder& in, BlockState& block);
void read_derived(RangeDecoder& in, BlockState& block);
void read_layer(RangeDecoder& in, BlockState& block, const BlockLayer& layer,
                std::vector<Code>& codes);
void read_labels(RangeDecoder& in, BlockState& block);

}  // namespace plain
