// Eight floats at once, in two registers of four: sums, products, quotients and roots that are each
// rounded to nearest, the same as one by one.
//
//   const EightFloats z = (EightFloats(x) - center) * inverse_scale;
//   (z / root(1.0f + z * z)).store(result);
#pragma once

#include "base/four_floats.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace crease::codec {

using crease::greater;
using crease::lesser;
using crease::root;

struct EightFloats {
  FourFloats low, high;

  EightFloats(const FourFloats& l, const FourFloats& h) : low(l), high(h) {}
  EightFloats(float x) : low{x, x, x, x}, high{x, x, x, x} {}
  explicit EightFloats(const std::array<float, 8>& x) {
    std::memcpy(&low, x.data(), sizeof low);
    std::memcpy(&high, x.data() + 4, sizeof high);
  }
  void store(std::array<float, 8>& x) const { store(x.data()); }
  static EightFloats load(const float* x) {
    FourFloats l, h;
    std::memcpy(&l, x, sizeof l);
    std::memcpy(&h, x + 4, sizeof h);
    return {l, h};
  }
  void store(float* x) const {
    std::memcpy(x, &low, sizeof low);
    std::memcpy(x + 4, &high, sizeof high);
  }
};

inline EightFloats operator+(const EightFloats& a, const EightFloats& b) {
  return {a.low + b.low, a.high + b.high};
}
inline EightFloats operator-(const EightFloats& a, const EightFloats& b) {
  return {a.low - b.low, a.high - b.high};
}
inline EightFloats operator*(const EightFloats& a, const EightFloats& b) {
  return {a.low * b.low, a.high * b.high};
}
inline EightFloats operator/(const EightFloats& a, const EightFloats& b) {
  return {a.low / b.low, a.high / b.high};
}
inline EightFloats root(const EightFloats& x) {
  return {root(x.low), root(x.high)};
}
inline EightFloats lesser(const EightFloats& a, const EightFloats& b) {
  return {lesser(a.low, b.low), lesser(a.high, b.high)};
}
inline EightFloats greater(const EightFloats& a, const EightFloats& b) {
  return {greater(a.low, b.low), greater(a.high, b.high)};
}
inline float greatest_of(const EightFloats& x) {
  const FourFloats m = greater(x.low, x.high);
  const float a = m[0] > m[1] ? m[0] : m[1], b = m[2] > m[3] ? m[2] : m[3];
  return a > b ? a : b;
}

// -1 where something holds, else 0.
struct EightInts {
  FourInts low, high;
  void store(std::int32_t* x) const {
    std::memcpy(x, &low, sizeof low);
    std::memcpy(x + 4, &high, sizeof high);
  }
};
inline EightInts operator>(const EightFloats& a, const EightFloats& b) {
  return {a.low > b.low, a.high > b.high};
}
// 0 where it does not hold.
inline EightFloats operator&(const EightInts& is, const EightFloats& x) {
  return {std::bit_cast<FourFloats>(is.low & std::bit_cast<FourInts>(x.low)),
          std::bit_cast<FourFloats>(is.high & std::bit_cast<FourInts>(x.high))};
}

// In this order.
inline float sum_of(const EightFloats& x) {
  const FourFloats s = x.low + x.high;
  return (s[0] + s[1]) + (s[2] + s[3]);
}

// About 2^x, each as rough_exp2().
inline FourFloats rough_exp2_of_each(const FourFloats& x) {
  const FourInts whole = __builtin_convertvector(x, FourInts);
  const FourFloats t = x - __builtin_convertvector(whole, FourFloats);
  return std::bit_cast<FourFloats>((whole + (127 - 64)) << 23) * (1 + t - 0.34f * t * (1 - t));
}
inline EightFloats rough_exp2(const EightFloats& x) {
  const EightFloats up = lesser(greater(x, -60.0f), 60.0f) + 64.0f;
  return {rough_exp2_of_each(up.low), rough_exp2_of_each(up.high)};
}

}  // namespace crease::codec
