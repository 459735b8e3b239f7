// Between which two vertices of its ring a vertex is likely to be split: the odds of all pairs, by
// a score that learns, within a block, from the splits before. Floats without fused products, as
// in predict_position.h.
//
//   odds.rate(places, ring);
//   const PairOdds::Pair pair = odds.code(coder, known_pair);
//   odds.learn(pair);
#pragma once

#include "base/wide.h"
#include "codec/shares.h"
#include "codec/spot.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease::codec {

struct RingVertex {
  std::size_t triangles = 0;  // at the vertex
  bool was_split = false;     // in this block
};

class PairOdds {
 public:
  static constexpr std::size_t kMost = 16;  // vertices
  struct Pair {
    std::uint32_t first = 0, last = 1;  // places in the ring, first < last
  };

  // Of a closed ring of 2 to kMost vertices, whose places are seen from the centre, grid units.
  // Time O(n^2).
  void rate(std::span<const Spot> places, std::span<const RingVertex> ring);

  // The first, then the last of those after it.
  template <class Coder>
  Pair code(Coder& coder, const Pair& pair) const {
    const Shares<kMost> of_first(up_to_, 0, count_ - 1);
    const std::uint32_t first = coder.one_of(of_first, pair.first);
    const std::uint32_t after = count_ - 1 - first;
    std::array<float, kMost> up_to{};
    float sum = 0;
    const FourFloats* const odds = odds_of(first);
    for (std::uint32_t j = 0; j < after; ++j) up_to[j] = sum += odds[j / 4][j % 4];
    const Shares<kMost> of_last(up_to, 0, after);
    return {first, first + 1 + coder.one_of(of_last, pair.last - first - 1)};
  }

  // What rate() was asked for turned out to be split at `pair`.
  void learn(const Pair& pair);

 private:
  static constexpr std::size_t kOfPair = 6, kOfVertex = 3, kTriangles = 8, kChildTriangles = 7;
  // Pairs by first, then by last; in fours, and those of each first begin with a new four.
  static constexpr std::size_t kFours = 36;
  using PerFour = std::array<FourFloats, kFours>;
  using PerVertex = std::array<float, kMost + 4>;
  struct Plan;  // which pairs each four has
  static const Plan kPlans[];
  struct Rated {  // what speaks for pairs, per vertex, with four zeros behind the last one
    PerVertex x, y, z, sum_x, sum_y, sum_z;  // where it is, and the sum up to it
    PerVertex inverse_length;                // or 0
    PerVertex of_vertex, of_arc;             // scores
    Spot all{};                              // the sum of all places
    float inverse = 1;                       // of the mean length
  };

  const FourFloats* odds_of(std::uint32_t first) const;
  void rate_vertices(std::span<const RingVertex> ring, Rated& rated);
  void rate_pairs(const Rated& rated);
#if defined(CREASE_AVX2)
  CREASE_AVX2 void rate_pairs_wide(const Rated& rated);
#endif

  // Weights of what speaks for a pair: of both together, of each vertex, of the triangles at each
  // vertex, and of those that each child gets.
  std::array<float, kOfPair> of_pair_{-1.548f, 0.317f, 0.683f, 0.438f, 1.564f, -0.647f};
  std::array<float, kOfVertex> of_vertex_{-0.417f, 0.436f, -0.333f};
  std::array<float, kTriangles> of_triangles_{0.737f,  0.335f,  0.196f,  -0.299f,
                                              -0.169f, -0.343f, -0.081f, 0.805f};
  std::array<float, kChildTriangles> of_child_{-1.507f, 0.416f, 1.112f, 1.252f, 0.731f, 0.405f, 0};

  std::uint32_t count_ = 0;
  float sum_ = 0;
  std::array<std::array<float, kOfVertex>, kMost> vertex_features_;
  std::array<std::size_t, kMost> triangles_class_;
  std::array<PerFour, kOfPair> pair_features_;
  PerFour odds_;                      // the greatest is 1; 0 of what is no pair
  std::array<float, kMost> up_to_{};  // the odds of all pairs of those up to each first
};

}  // namespace crease::codec
