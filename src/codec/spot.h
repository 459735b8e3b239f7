// Places as seen from a vertex, and directions: x, y, z and a zero in four floats. Floats without
// fused products, each sum in the order of docs/format-block.md, so that encoder and decoder get
// the same to the bit on every machine.
#pragma once

#include "base/four_floats.h"
#include "crease/vec.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace crease::codec {

using Spot = FourFloats;

// Of p, from `from`; differences of coordinates go round at 2^32.
inline Spot seen_from(const Vec3i& from, const Vec3i& p) {
  using FourWords [[gnu::vector_size(16)]] = std::uint32_t;
  const auto words = [](const Vec3i& v) {
    return std::bit_cast<FourWords>(FourInts{v.x, v.y, v.z, 0});
  };
  return __builtin_convertvector(std::bit_cast<FourInts>(words(p) - words(from)), Spot);
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
