// Deering's direction codes (Geometry Compression, SIGGRAPH 1995), which G03 stores normals with:
// the signs of a vector, the order of its components, and two angles within what is left, a 48th of
// the sphere.
//
//   const SextantCoding coding(6);                        // bits an angle; 6 is G03's 17 bits
//   const SextantCode code = coding.encode({0, 0.6, 0.8});
//   const Vec3f n = coding.decode(code);                  // unit length, within 0.65 degrees
//
//           (1,1,1)     Sorted, absolute components x >= z >= y are the triangle on the left. With
//              /|       N = 2^bits and f = atan(1 / sqrt 2), the angle phi is f * phi_code / N, and
//            /  | phi   theta is asin(tan(f * (N - theta_code) / N)). The direction is (cos theta
//          /    |       cos phi, sin phi, sin theta cos phi). On the slanted side z = y, which is
//        *------*       phi_code = N - theta_code, so the codes fill the triangle.
//   (1,0,0)  (1,0,1)
//     theta = N..0      Three bits of signs, six orders, two angles: 18 bits with bits = 6; or 17,
//                       as the angles fill half a square. There are 24 N^2 + 2 directions: 98306.
//
// Directions on the sides of the triangle have several codes. The canonical one names the lower
// axis first where components are equal and has no sign where one is zero. Sines and tangents come
// from bisecting the angle with roots and quotients alone, so decoding gives the same bits
// everywhere.
#pragma once

#include "crease/vec.h"

#include <cstdint>
#include <vector>

namespace crease {

struct SextantCode {
  std::uint8_t octant = 0;   // bit k: component k is negative
  std::uint8_t sextant = 0;  // the order of the components' sizes: xyz xzy yxz yzx zxy zyx
  std::uint16_t theta = 0, phi = 0;
  bool operator==(const SextantCode&) const = default;
};

// Across a side of the triangle the angles go on, mirrored. So between near directions the angles
// differ by little always, and the symbols are zero mostly.
struct SextantResidual {
  std::uint8_t octant = 0;   // 0..7: signs that differ
  std::uint8_t sextant = 0;  // 0..5: the order relative to the expected order
  std::int32_t theta = 0, phi = 0;
  bool operator==(const SextantResidual&) const = default;
};

class SextantCoding {
 public:
  static constexpr int kMinBits = 2, kMaxBits = 12;

  // Makes tables of 24 bytes times 2^bits.
  explicit SextantCoding(int bits);

  std::uint32_t angle_count() const { return n_; }  // N: theta and phi go from 0 to N
  std::uint64_t direction_count() const { return 24 * std::uint64_t(n_) * n_ + 2; }

  // The canonical code whose direction is nearest, of any finite vector; zero gives zero().
  SextantCode encode(const Vec3d& direction) const;
  SextantCode encode(const Vec3f& d) const {
    return encode(Vec3d{double(d.x), double(d.y), double(d.z)});
  }
  // The code must hold has_direction(), or be zero().
  Vec3f decode(SextantCode code) const;

  // Outside of the triangle, so that the zero vector, no direction, survives as well.
  SextantCode zero() const {
    return {0, 0, static_cast<std::uint16_t>(n_), static_cast<std::uint16_t>(n_)};
  }
  bool has_direction(SextantCode code) const;
  // Canonical or zero(): what encode() gives, and what a file may hold.
  bool is_canonical(SextantCode code) const;
  SextantCode canonical(SextantCode code) const;  // has_direction() must hold

  SextantResidual residual(SextantCode code, SextantCode predicted) const;
  // The inverse. A residual from a file may lead anywhere: check is_canonical() of the result.
  SextantCode restore(SextantResidual residual, SextantCode predicted) const;

 private:
  Vec3d in_triangle(std::uint32_t theta, std::uint32_t phi) const;

  std::uint32_t n_;
  std::vector<double> sine_, cosine_, tangent_;  // of f * i / N, n_ + 1 values each
};

}  // namespace crease
