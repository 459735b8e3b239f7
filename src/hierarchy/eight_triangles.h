// Eight triangles that share a corner, the origin, and how far points are from them; for loops over
// all triangles around a vertex.
//
//   blocks[i / 8].put(i % 8, next - v, previous - v);   // for the i-th
//   for (b : blocks) b.prepare();
//   blocks[b].find_nearest(p, b, best, at);
//
// Whoever calls is compiled for the widest registers there are (base/wide.h); results go where they
// are told, since not all callers know registers of eight floats.
#pragma once

#include "crease/vec.h"

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace crease {

struct EightTriangles {
  static constexpr std::size_t kLanes = 8;
  using Lanes = float __attribute__((vector_size(32), aligned(16)));
  using Ints = std::int32_t __attribute__((vector_size(32), aligned(16)));
  static constexpr float kTiny = 1e-30f, kHandicap = 1e-12f;

  [[gnu::always_inline]] static inline void product(const Lanes* a, const Lanes* b, Lanes& result) {
    result = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  [[gnu::always_inline]] static inline void cross(const Lanes* a, const Lanes* b, Lanes* result) {
    result[0] = a[1] * b[2] - a[2] * b[1];
    result[1] = a[2] * b[0] - a[0] * b[2];
    result[2] = a[0] * b[1] - a[1] * b[0];
  }
  // table[which[i]] for all i.
  [[gnu::always_inline]] static inline void pick(const Lanes& table, const Ints& which,
                                                 Lanes& result) {
#if defined(__clang__)
    for (std::size_t i = 0; i < kLanes; ++i) result[i] = table[which[i]];
#else
    result = __builtin_shuffle(table, which);
#endif
  }

  Lanes next[3], previous[3], normal[3];
  Lanes to_next[3], to_previous[3];  // products with them are barycentric coordinates
  Lanes per_next, per_previous, per_side, per_normal;  // one over squared lengths
  // Without area: so much farther, so that of two that are as near the other one is it.
  Lanes handicap;

  // The first fills all lanes: what no other triangle takes is this one again.
  void put(std::size_t lane, const Vec3d& to_next_corner, const Vec3d& to_previous_corner) {
    for (int i = 0; i < 3; ++i) {
      const auto n = static_cast<float>(to_next_corner[i]);
      const auto p = static_cast<float>(to_previous_corner[i]);
      if (lane == 0) {
        next[i] = Lanes{} + n;
        previous[i] = Lanes{} + p;
      }
      next[i][lane] = n;
      previous[i][lane] = p;
    }
  }

  [[gnu::always_inline]] inline void prepare() {
    const Lanes none{};
    const auto over = [&](const Lanes* v, Lanes& inverse) __attribute__((always_inline)) {
      Lanes squared;
      product(v, v, squared);
      inverse = squared > kTiny ? 1.0f / squared : none;
    };
    const Lanes side[] = {previous[0] - next[0], previous[1] - next[1], previous[2] - next[2]};
    cross(next, previous, normal);
    over(next, per_next);
    over(previous, per_previous);
    over(side, per_side);
    over(normal, per_normal);
    product(side, side, handicap);
    Lanes other;
    product(next, next, other);
    handicap = per_normal > none ? none : kHandicap * (handicap + other);
    cross(previous, normal, to_next);
    cross(normal, next, to_previous);
    for (int i = 0; i < 3; ++i) {
      to_next[i] *= per_normal;
      to_previous[i] *= per_normal;
    }
  }

  // One of these triangles for each lane of the result.
  [[gnu::always_inline]] inline void pick_into(const Ints& which, EightTriangles& result) const {
    for (int i = 0; i < 3; ++i) {
      pick(next[i], which, result.next[i]);
      pick(previous[i], which, result.previous[i]);
      pick(normal[i], which, result.normal[i]);
      pick(to_next[i], which, result.to_next[i]);
      pick(to_previous[i], which, result.to_previous[i]);
    }
    pick(per_next, which, result.per_next);
    pick(per_previous, which, result.per_previous);
    pick(per_side, which, result.per_side);
    pick(per_normal, which, result.per_normal);
    pick(handicap, which, result.handicap);
  }

  // Squared distances of p.
  [[gnu::always_inline]] inline void measure(const Lanes* p, Lanes& squared) const {
    const Lanes none{}, one = none + 1.0f;
    const auto to_side = [&](const Lanes* from, const Lanes* side, const Lanes& inverse,
                             Lanes& result) __attribute__((always_inline)) {
      Lanes t;
      product(from, side, t);
      t *= inverse;
      t = t > none ? t : none;
      t = t < one ? t : one;
      const Lanes d[] = {from[0] - t * side[0], from[1] - t * side[1], from[2] - t * side[2]};
      product(d, d, result);
    };
    const Lanes q[] = {p[0] - next[0], p[1] - next[1], p[2] - next[2]};
    const Lanes side[] = {previous[0] - next[0], previous[1] - next[1], previous[2] - next[2]};
    Lanes first, second, third, over, u, v;
    to_side(p, next, per_next, first);
    to_side(p, previous, per_previous, second);
    to_side(q, side, per_side, third);
    Lanes nearest = first < second ? first : second;
    nearest = nearest < third ? nearest : third;
    product(p, normal, over);
    product(p, to_next, u);
    product(p, to_previous, v);
    const auto is_over = (u > none) & (v > none) & (u + v < one);
    squared = is_over ? over * per_normal * over : nearest + handicap;
  }

  // If one of these triangles, those from place 8 b on, is nearer to p than the best so far; of
  // two that are about as near, which is a few of the last bits, the first.
  [[gnu::always_inline]] inline void find_nearest(const Lanes* p, std::size_t b, float& best,
                                                  std::uint32_t& at) const {
    Lanes squared;
    measure(p, squared);
    // Floats that are not negative lie in order as integers do.
    Ints key, other;
    std::memcpy(&key, &squared, sizeof key);
    key = (key & -8) | Ints{0, 1, 2, 3, 4, 5, 6, 7};
    other = __builtin_shufflevector(key, key, 4, 5, 6, 7, 0, 1, 2, 3);
    key = key < other ? key : other;
    other = __builtin_shufflevector(key, key, 2, 3, 0, 1, 6, 7, 4, 5);
    key = key < other ? key : other;
    other = __builtin_shufflevector(key, key, 1, 0, 3, 2, 5, 4, 7, 6);
    key = key < other ? key : other;
    const auto lane = static_cast<std::size_t>(key[0] & 7);
    const bool nearer = squared[lane] < best;
    best = nearer ? squared[lane] : best;
    at = nearer ? static_cast<std::uint32_t>(b * kLanes + lane) : at;
  }
};

}  // namespace crease
