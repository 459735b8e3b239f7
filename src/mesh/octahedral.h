// Octahedral direction codes: the sphere as a square of integers.
//
//   const OctahedralCoding coding(10);                    // bits a component
//   const OctahedralCode code = coding.encode({0, 0.6, 0.8});
//   const Vec3f n = coding.decode(code);                  // unit length, within 0.16 degrees
//
// A direction goes to the octahedron |x| + |y| + |z| = m and, seen from +z, to the square: the
// upper half is the diamond inside, the lower half is folded out over the diamond's four sides.
//
//      *-------*-------*     With integers x, y in [-m, m] the point is (x, y, m - |x| - |y|) or,
//      | -z  / | \  -z |     where that is below zero, (m - |y|, m - |x|) with the signs of x and
//      |   / +z| +z\   |     y. So every code is an integer vector of integer squared length, and
//      *-------o-------*     decoding is one correctly rounded root and three quotients: the same
//      |   \ +z| +z/   |     bits with every compiler and on every processor.
//      | -z  \ | /  -z |
//      *-------*-------*     m is the largest multiple of 6 below 2^(bits - 1), so that the axes
//                            and the diagonals (1,1,0) and (1,1,1) are codes.
//
// The two halves of each side of the square are one curve, its corners one point: such directions
// have several codes. The canonical one has y >= 0 where |x| = m and x >= 0 where |y| = m. There
// are 4 m^2 + 2 directions. One code that is not canonical, (0, 0), stands for the zero vector,
// which is no direction but occurs among normals.
#pragma once

#include "base/four_floats.h"
#include "crease/vec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>

namespace crease {

struct OctahedralCode {
  std::uint32_t u = 0, v = 0;  // x + m and y + m
  bool operator==(const OctahedralCode&) const = default;
};

struct OctahedralResidual {
  std::int32_t x = 0, y = 0;  // each in [-m, m]
  bool operator==(const OctahedralResidual&) const = default;
};

class OctahedralCoding {
 public:
  static constexpr int kMinBits = 4, kMaxBits = 16;

  explicit OctahedralCoding(int bits);

  // The largest component of a code, 2 m.
  std::uint32_t max_component() const { return 2 * static_cast<std::uint32_t>(m_); }
  std::uint64_t direction_count() const { return 4 * std::uint64_t(m_) * std::uint64_t(m_) + 2; }

  // The canonical code whose direction is nearest, of any finite vector. Zero gives kZero, which
  // decodes to zero. Integers throughout but for the candidates' lengths.
  OctahedralCode encode(const Vec3d& direction) const;
  // The same; less work where a code has just this direction.
  OctahedralCode encode(const Vec3f& d) const {
    const std::optional<OctahedralCode> exact = exact_code(d);
    return exact ? *exact : encode(Vec3d{double(d.x), double(d.y), double(d.z)});
  }
  // The canonical code, or kZero, that decodes to just this vector, if there is one.
  std::optional<OctahedralCode> exact_code(const Vec3f& direction) const;
  // Both components must be in range; the code need not be canonical.
  Vec3f decode(OctahedralCode code) const;

  static constexpr OctahedralCode kZero{0, 0};
  // Canonical or kZero: what encode() gives, and what a file may hold.
  bool is_canonical(OctahedralCode code) const;
  OctahedralCode canonical(OctahedralCode code) const;

  // What is left of a code where another is expected, small where the directions are near: both are
  // turned so that the expected one lies inside the diamond, away from the folds, in the quadrant
  // x > 0, y >= 0. Then it is a difference, taken around the square. Both codes canonical.
  OctahedralResidual residual(OctahedralCode code, OctahedralCode predicted) const {
    return residual(code, frame_of(predicted));
  }
  // The inverse of residual(). Any numbers give a canonical code, so a file's need no check.
  OctahedralCode restore(OctahedralResidual residual, OctahedralCode predicted) const {
    return restore(residual, frame_of(predicted));
  }

  struct Point {
    std::int32_t x = 0, y = 0;
  };
  struct Frame {  // how a prediction is turned
    bool flip = false;
    int turns = 0;
    Point predicted{};
  };
  // The same, of what several residuals have in common.
  Frame frame_of(OctahedralCode predicted) const;
  // Canonical; of a point of the square, x and y in about [-m, m].
  OctahedralCode near(float x, float y) const;
  OctahedralResidual residual(OctahedralCode code, const Frame& frame) const;
  OctahedralCode restore(OctahedralResidual residual, const Frame& frame) const;

 private:
  Point point_of(OctahedralCode code) const;
  OctahedralCode code_of(Point p) const;
  Point folded(Point p) const;
  Point inside(Point p) const;
  Point settled(Point p) const;  // canonical
  std::int32_t wrapped(std::int64_t x) const;

  std::int32_t m_;
};

// The integer vector of a point of the square.
inline Vec3i octahedral_vector(std::int32_t m, std::int32_t x, std::int32_t y) {
  const std::int32_t size_x = std::abs(x), size_y = std::abs(y), z = m - size_x - size_y;
  // Without a branch: which half it is in, nobody can foretell.
  const std::int32_t sign_x = x >> 31, sign_y = y >> 31, below = z >> 31;  // -1 or 0
  const std::int32_t folded_x = ((m - size_y) ^ sign_x) - sign_x;
  const std::int32_t folded_y = ((m - size_x) ^ sign_y) - sign_y;
  return {x ^ ((x ^ folded_x) & below), y ^ ((y ^ folded_y) & below), z};
}

// decode() for those who keep no coding: max_component = 2 m.
inline Vec3f octahedral_direction(std::uint32_t max_component, OctahedralCode code) {
  if (code == OctahedralCoding::kZero) return {};
  const auto m = static_cast<std::int32_t>(max_component / 2);
  const Vec3i n = octahedral_vector(m, static_cast<std::int32_t>(code.u) - m,
                                    static_cast<std::int32_t>(code.v) - m);
  using Pair = double __attribute__((vector_size(16)));
  const double z = n.z;
  Pair xy{double(n.x), double(n.y)};
  // Of a whole number. One division and three products give the floats that three divisions would:
  // so it is for all codes of all lattices of 8 to 16 bits, which were tried one by one.
  const double per_size = 1 / std::sqrt(xy[0] * xy[0] + xy[1] * xy[1] + z * z);
  xy *= Pair{per_size, per_size};
  return {static_cast<float>(xy[0]), static_cast<float>(xy[1]), static_cast<float>(z * per_size)};
}

// The same of four codes at once, the same to the bit: their x, y and z.
inline std::array<FourFloats, 3> octahedral_directions(std::uint32_t max_component,
                                                       const FourInts& u, const FourInts& v) {
  const auto m = static_cast<std::int32_t>(max_component / 2);
  const FourInts x = u - m, y = v - m;
  const FourInts sign_x = x >> 31, sign_y = y >> 31;
  const FourInts size_x = (x ^ sign_x) - sign_x, size_y = (y ^ sign_y) - sign_y;
  const FourInts z = m - size_x - size_y, below = z >> 31;
  const FourInts folded_x = ((m - size_y) ^ sign_x) - sign_x;
  const FourInts folded_y = ((m - size_x) ^ sign_y) - sign_y;
  const std::array<FourDoubles, 3> n{FourDoubles::from(x ^ ((x ^ folded_x) & below)),
                                     FourDoubles::from(y ^ ((y ^ folded_y) & below)),
                                     FourDoubles::from(z)};
  constexpr FourDoubles kOne{{1, 1}, {1, 1}};
  const FourDoubles per_size = kOne / root(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const FourInts is_zero = (u | v) == 0;
  std::array<FourFloats, 3> found;
  for (std::size_t k = 0; k < 3; ++k)
    found[k] = is_zero ? FourFloats{} : (n[k] * per_size).rounded();
  return found;
}

// The bits, 8 to 16, of the coarsest lattice that has each of these vectors of three exactly; none
// if no lattice has them all. Time O(size), and little where there is none.
std::optional<int> octahedral_bits_of(std::span<const float> directions);

}  // namespace crease
