// Small vectors. Plain aggregates, no hidden work; double for geometry, int32 for grid positions.
//
//   Vec3d n = normalized(cross(b - a, c - a));
#pragma once

#include <cmath>
#include <cstdint>

namespace crease {

template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3 operator+(const Vec3& o) const { return {T(x + o.x), T(y + o.y), T(z + o.z)}; }
  constexpr Vec3 operator-(const Vec3& o) const { return {T(x - o.x), T(y - o.y), T(z - o.z)}; }
  constexpr Vec3 operator*(T s) const { return {T(x * s), T(y * s), T(z * s)}; }
  constexpr Vec3 operator-() const { return {T(-x), T(-y), T(-z)}; }
  constexpr Vec3& operator+=(const Vec3& o) { return *this = *this + o; }
  constexpr Vec3& operator-=(const Vec3& o) { return *this = *this - o; }
  constexpr bool operator==(const Vec3&) const = default;
  constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Vec3i = Vec3<std::int32_t>;

constexpr Vec3d to_double(const Vec3f& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

template <typename T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
T length(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}

// The zero vector stays zero.
template <typename T>
Vec3<T> normalized(const Vec3<T>& a) {
  const T l = length(a);
  return l > T(0) ? a * (T(1) / l) : a;
}

constexpr double kPi = 3.14159265358979323846;
constexpr double radians(double degrees) {
  return degrees * (kPi / 180.0);
}
constexpr double degrees(double radians) {
  return radians * (180.0 / kPi);
}

}  // namespace crease
