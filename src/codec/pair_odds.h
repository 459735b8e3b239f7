// Between which two vertices of its ring a vertex is likely to be split: the odds of all pairs, by
// a score that learns, within a block, from the splits before. Doubles without fused products, as
// in predict_position.h.
//
//   odds.rate(ring);
//   const PairOdds::Pair pair = odds.code(coder, known_pair);
//   odds.learn(pair);
#pragma once

#include "codec/known_bit.h"
#include "crease/vec.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease::codec {

struct RingVertex {
  Vec3d position{};           // from the centre, grid units
  std::size_t triangles = 0;  // at the vertex
  bool was_split = false;     // in this block
};

class PairOdds {
 public:
  static constexpr std::size_t kMost = 16;  // vertices
  struct Pair {
    std::uint32_t first = 0, last = 1;  // places in the ring, first < last
  };

  // Of a closed ring of 2 to kMost vertices. Time O(n^2).
  void rate(std::span<const RingVertex> ring);

  // The first by halving, then the last.
  template <class Coder>
  Pair code(Coder& coder, const Pair& pair) const {
    std::array<double, kMost + 1> up_to;  // the odds of all before
    up_to[0] = 0;
    for (std::uint32_t i = 0; i + 1 < count_; ++i) {
      double sum = 0;
      for (std::uint32_t j = i + 1; j < count_; ++j) sum += odds_[i][j];
      up_to[i + 1] = up_to[i] + sum;
    }
    const std::uint32_t first = halve(coder, up_to, 0, count_ - 1, pair.first);
    up_to[first + 1] = 0;
    for (std::uint32_t j = first + 1; j < count_; ++j) up_to[j + 1] = up_to[j] + odds_[first][j];
    return {first, halve(coder, up_to, first + 1, count_, pair.last)};
  }

  // What rate() was asked for turned out to be split at `pair`.
  void learn(const Pair& pair);

 private:
  static constexpr std::size_t kOfPair = 6, kOfVertex = 3, kTriangles = 8, kChildTriangles = 7;

  // One of [low, high).
  template <class Coder>
  static std::uint32_t halve(Coder& coder, const std::array<double, kMost + 1>& up_to,
                             std::uint32_t low, std::uint32_t high, std::uint32_t value) {
    while (high - low > 1) {
      const std::uint32_t middle = (low + high) / 2;
      KnownBit is_upper(up_to[high] - up_to[middle], up_to[high] - up_to[low]);
      if (coder.bit(is_upper, value >= middle)) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return low;
  }

  std::size_t child_class(std::size_t arc) const;  // of a child with so many old triangles

  // Weights of what speaks for a pair: of both together, of each vertex, of the triangles at each
  // vertex, and of those that each child gets.
  std::array<double, kOfPair> of_pair_{-1.548, 0.317, 0.683, 0.438, 1.564, -0.647};
  std::array<double, kOfVertex> of_vertex_{-0.417, 0.436, -0.333};
  std::array<double, kTriangles> of_triangles_{0.737,  0.335,  0.196,  -0.299,
                                               -0.169, -0.343, -0.081, 0.805};
  std::array<double, kChildTriangles> of_child_{-1.507, 0.416, 1.112, 1.252, 0.731, 0.405, 0};

  std::uint32_t count_ = 0;
  double sum_ = 0;
  std::array<std::array<double, kOfVertex>, kMost> vertex_features_;
  std::array<std::size_t, kMost> triangles_class_;
  std::array<std::array<std::array<double, kOfPair>, kMost>, kMost> pair_features_;
  std::array<std::array<double, kMost>, kMost> odds_;  // the greatest is 1
};

}  // namespace crease::codec
