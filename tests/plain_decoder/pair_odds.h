// docs/format-block.md, "Odds of pairs".
#pragma once

#include "plain_decoder/arithmetic.h"
#include "plain_decoder/bits.h"
#include "plain_decoder/tables.h"

#include <array>
#include <cstddef>
#include <vector>

namespace plain {

struct FanVertex {
  FloatVector place;  // as seen from the vertex that is split
  std::size_t triangles = 0;
  bool was_split = false;
};

class PairOdds {
 public:
  struct Pair {
    std::size_t i = 0, j = 0;
  };

  // Of a closed fan of 2 to 16 vertices; the weights learn.
  Pair read(RangeDecoder& in, const std::vector<FanVertex>& fan);

 private:
  struct Rated {  // a pair
    std::array<float, 6> features{};
    float odds = 0;
  };

  void rate(const std::vector<FanVertex>& fan);
  void learn(const std::vector<FanVertex>& fan, const Pair& pair);

  std::array<float, 6> both_ = kBothWeights;
  std::array<float, 3> each_ = kEachWeights;
  std::array<float, 8> triangles_ = kTrianglesWeights;
  std::array<float, 7> child_ = kChildWeights;

  std::vector<std::array<float, 3>> features_;  // per vertex
  std::vector<std::vector<Rated>> rated_;       // per i and j
  std::vector<float> sums_;                     // U, per i
  float all_ = 0;                               // T
};

}  // namespace plain
