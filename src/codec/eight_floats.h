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
#include <limits>

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
inline EightInts operator^(const EightInts& is, std::int32_t other) {
  return {is.low ^ other, is.high ^ other};
}
inline EightFloats size_of(const EightFloats& x) {
  return {std::bit_cast<FourFloats>(std::bit_cast<FourInts>(x.low) & 0x7fffffff),
          std::bit_cast<FourFloats>(std::bit_cast<FourInts>(x.high) & 0x7fffffff)};
}
// Of `size`, whose own sign does not count.
inline FourFloats with_sign_of(const FourFloats& size, const FourFloats& sign) {
  constexpr std::int32_t kSign = std::numeric_limits<std::int32_t>::min();
  return std::bit_cast<FourFloats>((std::bit_cast<FourInts>(size) & 0x7fffffff) |
                                   (std::bit_cast<FourInts>(sign) & kSign));
}
inline EightFloats with_sign_of(const EightFloats& size, const EightFloats& sign) {
  return {with_sign_of(size.low, sign.low), with_sign_of(size.high, sign.high)};
}
// a where something holds, else b.
inline EightFloats chosen(const EightInts& is, const EightFloats& a, const EightFloats& b) {
  const auto of = [](const FourInts& i, const FourFloats& x, const FourFloats& y) {
    return std::bit_cast<FourFloats>((std::bit_cast<FourInts>(x) & i) |
                                     (std::bit_cast<FourInts>(y) & ~i));
  };
  return {of(is.low, a.low, b.low), of(is.high, a.high, b.high)};
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

// About log2(x), each as rough_log2().
inline FourFloats rough_log2_of_each(const FourFloats& x) {
  const FourInts bits = std::bit_cast<FourInts>(x);
  const FourFloats exponent = __builtin_convertvector((bits >> 23) - 127, FourFloats);
  const FourFloats t = std::bit_cast<FourFloats>((bits & ((1 << 23) - 1)) | 127 << 23) - 1.0f;
  return exponent + t + 0.34f * t * (1.0f - t);
}

// The angle whose sine and cosine are as y, not below zero, to x: in radians, within 0.00002.
inline FourFloats rough_angle(const FourFloats& y, const FourFloats& x) {
  const FourFloats width = greater(x, -x), most = greater(y, width);
  const FourFloats t = lesser(y, width) / most, s = t * t;
  const FourFloats low =
      t * (0.999866f + s * (-0.3302995f + s * (0.180141f + s * (-0.085133f + s * 0.0208351f))));
  const FourFloats acute = y > width ? 1.57079633f - low : low;
  return x < FourFloats{} ? 3.14159265f - acute : acute;
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
