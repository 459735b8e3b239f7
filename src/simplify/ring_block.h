// Four triangles of a pair's ring side by side, and what becomes of them when the end of the pair
// that they have moves.
#pragma once

#include "base/four_floats.h"
#include "hierarchy/quadric.h"
#include "simplify/flat_shading.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace crease::simplification {

using Lanes = decltype(Row{} < Row{});  // of each triangle: all bits, or none

// Two numbers that lie together at each of four places, side by side. Put together out of
// registers: a row of which the numbers are stored one by one cannot be loaded at once until they
// have reached the cache.
inline void take_pairs(const double* p0, const double* p1, const double* p2, const double* p3,
                       Row& first, Row& second) {
  using Pair [[gnu::vector_size(16)]] = double;
  const auto load = [](const double* p, Pair& pair) { std::memcpy(&pair, p, sizeof pair); };
  Pair at0, at1, at2, at3;
  load(p0, at0);
  load(p1, at1);
  load(p2, at2);
  load(p3, at3);
  const Row even = __builtin_shufflevector(at0, at2, 0, 1, 2, 3);
  const Row odd = __builtin_shufflevector(at1, at3, 0, 1, 2, 3);
  first = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
  second = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
}

inline void take_axes(const Vec3d& v0, const Vec3d& v1, const Vec3d& v2, const Vec3d& v3,
                      Row* axes) {
  Row y;
  take_pairs(&v0.x, &v1.x, &v2.x, &v3.x, axes[0], axes[1]);
  take_pairs(&v0.y, &v1.y, &v2.y, &v3.y, y, axes[2]);
}

inline void take_root(const Row& square, Row& root) {
  root =
      Row{std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]), std::sqrt(square[3])};
}

// FlatShading of four triangles, where some of them need it.
struct ShadingBlock {
  Row input_sum[3], input_area, faced[3], stored_error, stored_counts, counts;
  Lanes derived;

  // FlatShading::counts_with(), less what they count.
  void more_with(const Row* normal, const Row& area, Row& more) const {
    const Row none{};
    Row geometric = 2 * (input_area - (input_sum[0] * normal[0] + input_sum[1] * normal[1] +
                                       input_sum[2] * normal[2]));
    geometric = geometric > 0 ? geometric : none;
    const Lanes by_geometry = derived | (geometric + kDeriveMargin * input_area < stored_error);
    const Row turn[] = {normal[0] - faced[0], normal[1] - faced[1], normal[2] - faced[2]};
    const Row turn2 = turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2];
    const Row chord2 = by_geometry ? geometric / input_area : turn2;
    Row chord;
    take_root(chord2, chord);
    const Row linear = kLinearChord / (chord + kRoundingChord);
    const Row one = none + 1;
    const Row weighed = chord2 * (linear > 1 ? linear : one);
    const Row least_area = input_area < area ? input_area : area;
    const Row turned = turn2 > 2 ? area : least_area;
    const Row by_stored = stored_counts + turned * weighed;
    const Row by_input = geometric > 0 ? input_area * weighed : none;
    more = (by_geometry ? by_input : by_stored) - counts;
    more = more > 0 ? more : none;
  }
};

struct RingBlock {
  static constexpr std::size_t kTriangles = 4;

  // As they are: the two vertices that stay, unit normal (or zero), area.
  Row next[3], previous[3], normal[3];
  Row area;
  Lanes shows;             // is flat or derived
  Lanes right;             // and shows what it stands for
  std::uint32_t ring = 0;  // whose triangles these are: the pairs' rings are counted
  bool has_shading = false;
  ShadingBlock shading;

  struct Moved {
    Row normal[3];  // twice the area long
    Row length2;
    Row agreement;  // with the normal before, times the length
  };
  Moved moved_to(const Vec3d& target) const {
    Row u[3], v[3];
    for (int i = 0; i < 3; ++i) {
      u[i] = next[i] - target[i];
      v[i] = previous[i] - target[i];
    }
    Moved m;
    m.normal[0] = u[1] * v[2] - u[2] * v[1];
    m.normal[1] = u[2] * v[0] - u[0] * v[2];
    m.normal[2] = u[0] * v[1] - u[1] * v[0];
    const Row* n = m.normal;
    m.length2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    m.agreement = normal[0] * n[0] + normal[1] * n[1] + normal[2] * n[2];
    return m;
  }
};

// All bits where it is so.
inline void take_lanes(bool b0, bool b1, bool b2, bool b3, Lanes& lanes) {
  using Bytes [[gnu::vector_size(4)]] = std::int8_t;
  const std::uint32_t bytes = std::uint32_t(b0) | std::uint32_t(b1) << 8 | std::uint32_t(b2) << 16 |
                              std::uint32_t(b3) << 24;
  lanes = -__builtin_convertvector(std::bit_cast<Bytes>(bytes), Lanes);
}

// Of four floats at each of four places the first three, or all, side by side.
inline void take_floats(const float* p0, const float* p1, const float* p2, const float* p3,
                        Row* first_three, Row* fourth = nullptr) {
  FourFloats f0, f1, f2, f3;
  std::memcpy(&f0, p0, sizeof f0);
  std::memcpy(&f1, p1, sizeof f1);
  std::memcpy(&f2, p2, sizeof f2);
  std::memcpy(&f3, p3, sizeof f3);
  const FourFloats low01 = __builtin_shufflevector(f0, f1, 0, 4, 1, 5);
  const FourFloats low23 = __builtin_shufflevector(f2, f3, 0, 4, 1, 5);
  const FourFloats high01 = __builtin_shufflevector(f0, f1, 2, 6, 3, 7);
  const FourFloats high23 = __builtin_shufflevector(f2, f3, 2, 6, 3, 7);
  const auto widen = [](const FourFloats& x, Row& row) { row = __builtin_convertvector(x, Row); };
  widen(__builtin_shufflevector(low01, low23, 0, 1, 4, 5), first_three[0]);
  widen(__builtin_shufflevector(low01, low23, 2, 3, 6, 7), first_three[1]);
  widen(__builtin_shufflevector(high01, high23, 0, 1, 4, 5), first_three[2]);
  if (fourth != nullptr) widen(__builtin_shufflevector(high01, high23, 2, 3, 6, 7), *fourth);
}

// The lanes as bits, the first triangle's the lowest.
inline unsigned bits_of(const Lanes& lanes) {
#if defined(__SSE2__)
  const auto low = __builtin_shufflevector(lanes, lanes, 0, 1);
  const auto high = __builtin_shufflevector(lanes, lanes, 2, 3);
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(low)) |
                               _mm_movemask_pd(reinterpret_cast<__m128d>(high)) << 2);
#else
  const Lanes bits = lanes & Lanes{1, 2, 4, 8};
  return static_cast<unsigned>((bits[0] | bits[2]) | (bits[1] | bits[3]));
#endif
}

}  // namespace crease::simplification
