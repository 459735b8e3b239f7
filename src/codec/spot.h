// Places as seen from a vertex, and directions: x, y, z and a zero in four floats. Floats without
// fused products, each sum in the order of docs/format-block.md, so that encoder and decoder get
// the same to the bit on every machine.
#pragma once

#include "base/four_floats.h"
#include "crease/vec.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace crease::codec {

using Spot = FourFloats;

// Of p, from `from`; differences of coordinates go round at 2^32.
inline Spot seen_from(const Vec3i& from, const Vec3i& p) {
  using FourWords [[gnu::vector_size(16)]] = std::uint32_t;
  using TwoLongs [[gnu::vector_size(16)]] = std::int64_t;
  static_assert(sizeof(Vec3i) == 12);
  const auto words = [](const Vec3i& v) {  // in two loads
    std::int64_t xy;
    std::memcpy(&xy, &v, sizeof xy);
    return std::bit_cast<FourWords>(TwoLongs{xy, static_cast<std::uint32_t>(v.z)});
  };
  return __builtin_convertvector(std::bit_cast<FourInts>(words(p) - words(from)), Spot);
}
// Four spots' x, y and z, each of all four.
inline std::array<FourFloats, 3> coordinates_of(const Spot& a, const Spot& b, const Spot& c,
                                                const Spot& d) {
  const FourFloats xy_ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const FourFloats xy_cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const FourFloats z_ab = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const FourFloats z_cd = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(xy_ab, xy_cd, 0, 1, 4, 5),
          __builtin_shufflevector(xy_ab, xy_cd, 2, 3, 6, 7),
          __builtin_shufflevector(z_ab, z_cd, 0, 1, 4, 5)};
}
// And back.
inline std::array<Spot, 4> spots_at(const FourFloats& x, const FourFloats& y, const FourFloats& z) {
  const FourFloats xy_ab = __builtin_shufflevector(x, y, 0, 4, 1, 5);
  const FourFloats xy_cd = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  const FourFloats z_ab = __builtin_shufflevector(z, FourFloats{}, 0, 4, 1, 5);
  const FourFloats z_cd = __builtin_shufflevector(z, FourFloats{}, 2, 6, 3, 7);
  return {__builtin_shufflevector(xy_ab, z_ab, 0, 1, 4, 5),
          __builtin_shufflevector(xy_ab, z_ab, 2, 3, 6, 7),
          __builtin_shufflevector(xy_cd, z_cd, 0, 1, 4, 5),
          __builtin_shufflevector(xy_cd, z_cd, 2, 3, 6, 7)};
}
inline bool is_zero(const Spot& a) {
  return a[0] == 0 && a[1] == 0 && a[2] == 0;
}
inline Spot size_of_each(const Spot& a) {
  return std::bit_cast<Spot>(std::bit_cast<FourInts>(a) & 0x7fffffff);
}
// In this order.
inline float sum_of_three(const Spot& a) {
  return a[0] + a[1] + a[2];
}
inline float dot(const Spot& a, const Spot& b) {
  return sum_of_three(a * b);
}
inline float length(const Spot& a) {
  return std::sqrt(dot(a, a));
}
inline Spot normalized(const Spot& a) {
  const float l = length(a);
  return l > 0 ? a * (1 / l) : a;
}
// y, z, x.
inline Spot turned(const Spot& a) {
  return Spot{a[1], a[2], a[0], a[3]};
}
// The cross product as z, x, y: a sum of such is turned once.
inline Spot cross_before_turn(const Spot& a, const Spot& b) {
  return a * turned(b) - turned(a) * b;
}

}  // namespace crease::codec
