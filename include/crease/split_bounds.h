// What decides whether a vertex is split: errors, sphere and normal cone in 14 bytes.
//
//   const SplitBounds& b = hierarchy.vertices.bounds[index_of(s)];
//   if (b.surface.value() * pixels_per_unit > allowed) ...
#pragma once

#include "crease/contraction.h"
#include "crease/vec.h"

#include <array>
#include <cstdint>

namespace crease {

// A float of no sign in 16 bits, rounded up: 8 bits of exponent and 8 of mantissa, so at most
// 0.4 % more. Rounding is monotone, so what grows up the tree still does.
struct RoundedUp {
  std::uint16_t bits = 0;

  static RoundedUp from(float value);
  float value() const;
  bool operator==(const RoundedUp&) const = default;
};

// All normals in it are within half_angle of the axis.
struct NormalCone {
  Vec3f axis;
  float half_angle_rad = 0;  // pi: any direction
};

// What decides whether a vertex is split. 14 bytes; everything is rounded to the safe side.
struct SplitBounds {
  RoundedUp surface, line, degrees, texture;  // LevelError of v_s: its displacement if it stays
  // About v_s, model units: holds the spheres of v_t and v_u, and for a leaf its input triangles.
  RoundedUp radius;
  // Of the geometric normals of all input triangles at leaves below, and of all normals that the
  // attribute hierarchy has below or here.
  std::array<std::int8_t, 2> cone_axis{};  // octahedral
  std::uint8_t cone_angle = 255;           // of pi

  LevelError error() const {
    return {surface.value(), line.value(), degrees.value(), texture.value()};
  }
  NormalCone cone() const;
  void set_cone(const NormalCone& cone);
};

}  // namespace crease
