// docs/format-block.md, "Arithmetic": grid points, vectors of doubles, logarithms.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

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

struct Vector {
  double x = 0, y = 0, z = 0;

  double along(std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  bool is_zero() const { return x == 0 && y == 0 && z == 0; }
};
inline Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vector operator*(const Vector& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline double dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vector& a) {
  return std::sqrt(dot(a, a));
}
inline double length_1(const Vector& a) {
  return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}
inline Vector unit(const Vector& a) {
  const double l = length(a);
  return l > 0 ? a * (1 / l) : a;
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

inline double log2_of(double x) {
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
  const double e = double(std::int64_t(bits >> 52) - 1023);
  const std::uint64_t fraction = bits & 0xfffffffffffffu;
  const double t = std::bit_cast<double>(fraction | 0x3ff0000000000000u) - 1;
  return e + t + 0.34 * t * (1 - t);
}

inline double power_of_2(double x) {
  const double cut = std::clamp(x, -60.0, 60.0) + 64;
  const double w = std::floor(cut), t = cut - w;
  return std::ldexp(1.0, static_cast<int>(w) - 64) * (1 + t - 0.34 * t * (1 - t));
}

inline double angle_of(double y, double x) {
  const double m = std::max(y, std::abs(x));
  if (!(m > 0)) return 0;
  const double t = std::min(y, std::abs(x)) / m, s = t * t;
  const double inner = 0.180141 + s * (-0.085133 + s * 0.0208351);
  double result = t * (0.999866 + s * (-0.3302995 + s * inner));
  if (y > std::abs(x)) result = 1.5707963267948966 - result;
  return x < 0 ? 3.141592653589793 - result : result;
}

}  // namespace plain
