// docs/format-block.md, "Arithmetic": grid points, vectors, logarithms.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace plain {

// The bytes are not what the documents describe.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};
inline void demand(bool holds, const std::string& what) {
  if (!holds) throw Refused(what);
}

// Coordinates go round at 2^32.
inline std::int32_t sum_of(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

inline std::int32_t less(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

template <class Real>
struct VectorOf {
  Real x = 0, y = 0, z = 0;

  Real along(std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  bool is_zero() const { return x == 0 && y == 0 && z == 0; }

  friend VectorOf operator+(const VectorOf& a, const VectorOf& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend VectorOf operator-(const VectorOf& a, const VectorOf& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend VectorOf operator*(const VectorOf& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
};
using Vector = VectorOf<double>;
using FloatVector = VectorOf<float>;

template <class Real>
Real dot(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Real>
VectorOf<Real> cross(const VectorOf<Real>& a, const VectorOf<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
Real length(const VectorOf<Real>& a) {
  return std::sqrt(dot(a, a));
}
inline double length_1(const Vector& a) {
  return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}
template <class Real>
Real length_1(const VectorOf<Real>& a) {
  return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}
template <class Real>
VectorOf<Real> unit(const VectorOf<Real>& a) {
  const Real l = length(a);
  return l > 0 ? a * (1 / l) : a;
}
inline FloatVector sizes_of(const FloatVector& a) {
  return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}

// "By fours".
inline float sum_by_fours(const std::vector<float>& terms) {
  std::array<float, 4> sum{};
  for (std::size_t i = 0; i < terms.size(); ++i) sum[i % 4] += terms[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// A place on the grid.
struct Point {
  std::int32_t x = 0, y = 0, z = 0;

  std::int32_t& along(std::size_t axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  std::int32_t along(std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  bool operator==(const Point&) const = default;
};
inline Vector difference(const Point& p, const Point& from) {
  return {double(p.x) - double(from.x), double(p.y) - double(from.y), double(p.z) - double(from.z)};
}

// In f32, where coordinates go round.
inline FloatVector step(const Point& p, const Point& from) {
  return {float(less(p.x, from.x)), float(less(p.y, from.y)), float(less(p.z, from.z))};
}

inline float log2_of(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const float e = float(std::int32_t(bits >> 23) - 127);
  const float t = std::bit_cast<float>((bits & 0x7fffffu) | 0x3f800000u) - 1;
  return e + t + 0.34f * t * (1 - t);
}

inline float power_of_2(float x) {
  const float cut = std::clamp(x, -60.0f, 60.0f) + 64;
  const float w = std::floor(cut), t = cut - w;
  return std::ldexp(1.0f, static_cast<int>(w) - 64) * (1 + t - 0.34f * t * (1 - t));
}

inline float angle_of(float y, float x) {
  const float m = std::max(y, std::abs(x));
  if (!(m > 0)) return 0;
  const float t = std::min(y, std::abs(x)) / m, s = t * t;
  const float inner = 0.180141f + s * (-0.085133f + s * 0.0208351f);
  float result = t * (0.999866f + s * (-0.3302995f + s * inner));
  if (y > std::abs(x)) result = 1.57079633f - result;
  return x < 0 ? 3.14159265f - result : result;
}

}  // namespace plain
