// docs/format-block.md, "Directions".
#pragma once

#include "plain_decoder/block_decoder.h"
#include "plain_decoder/mixture.h"
#include "plain_decoder/tables.h"

#include <optional>
#include <vector>

namespace plain {

using Candidates = std::array<FloatVector, kComponents>;

class DirectionModel {
 public:
  DirectionModel(const DirectionStart& start, const Rates& rates);
  Code read(RangeDecoder& in, const Octahedral& coding, const Candidates& candidates,
            const Sizes& sizes);

 private:
  ComponentWeights weights_;
  ComponentScales scales_;
  MeanSizes mean_;
};

// One corner, and what is known of it.
struct CornerDirection {
  std::uint32_t vertex = 0;
  const std::vector<std::uint32_t>& corners;  // at the vertex
  std::size_t at = 0;                         // which of them
  bool is_fan = false, is_closed = false;
  std::optional<Code> had{}, tried{};  // at the coarse end; the one tried first
};

// The directions of one layer. The codes, and which of them are known, are the reader's.
class DirectionReader {
 public:
  DirectionReader(RangeDecoder& in, const BlockState& block, int bits,
                  const std::vector<Code>& codes, const std::vector<bool>& is_known);

  void store(std::uint32_t v, const Code& code) { stored_[v] = coding_.direction(code); }
  Code read_of_vertex(std::uint32_t v, const std::optional<Code>& had);
  Code read_of_corner(const CornerDirection& asked);

 private:
  FloatVector direction(const std::optional<Code>& code) const {
    return code ? coding_.direction(*code) : FloatVector{};
  }
  void add_onwards(const CornerDirection& asked, bool backwards, FloatVector& S,
                   FloatVector& B) const;

  RangeDecoder& in_;
  const BlockState& block_;
  const Surface& surface_;
  Octahedral coding_;
  const std::vector<Code>& codes_;
  const std::vector<bool>& is_known_;
  std::vector<FloatVector> geometric_, stored_;  // per vertex
  DirectionModel of_vertex_{kOfVertices, block_.schema.rates};
  DirectionModel of_corner_{kOfCorners, block_.schema.rates};
};

// The sum of twice the areas of each vertex' triangles, by number, of unit length.
std::vector<FloatVector> normals_of_vertices(const Surface& surface);

}  // namespace plain
