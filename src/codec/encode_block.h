// One block to bytes.
#pragma once

#include "codec/block_end.h"
#include "codec/decode_block.h"

#include <cstddef>
#include <vector>

namespace crease::codec {

// A block as the build knows it: a patch at the fine end of its band, and the contractions that
// lead to the coarse end. Vertices and triangles have numbers of this plan's own.
struct BlockPlan {
  struct Step {
    std::uint32_t removed = 0, kept = 0;  // the kept one's slot stands for the parent afterwards
    Vec3i position{};                     // of the parent
  };
  PatchMesh fine;                     // vertices are slots
  std::vector<std::uint32_t> labels;  // per triangle: patch of the next finer band, or 0
  std::vector<Step> steps;
};

struct EncodedBlock {
  std::vector<std::byte> bytes;
  DecodedBlock decoded;                         // what a decoder gets from them
  std::vector<std::uint32_t> plan_of_triangle;  // per triangle of the fine end
  std::vector<std::uint32_t> plan_of_vertex;    // per vertex of the fine end
};

// `names`: of the vertices of the plan that a coarser block has made; of others the block is kNone.
// Empty: of no root. `triangles` and `vertices`: of each triangle and vertex of `start` its number
// in the plan. What the plan has at its coarse end beside them is coded as roots. Of a triangle the
// corners may stand in another order at `start`, turned round.
EncodedBlock encode_block(const BlockPlan& plan, std::uint32_t block, const BlockCoding& coding,
                          CoarseEnd start, std::span<const std::uint32_t> triangles,
                          std::span<const std::uint32_t> vertices,
                          std::span<const VertexName> names = {});

}  // namespace crease::codec
