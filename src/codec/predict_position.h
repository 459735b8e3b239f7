// Where the two children of a split are expected, from the triangles that they have. Doubles
// without fused products: encoder and decoder get the same to the bit on every machine.
#pragma once

#include "codec/patch_mesh.h"

#include <array>
#include <cstdint>
#include <span>

namespace crease::codec {

// Sums of grid coordinates go round at 2^32, so that no bytes overflow them.
inline std::int32_t wrapped_sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
inline std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

// 2 log2(x), whole, from 0 to 31.
std::size_t half_octave(float x);
// About the x that gave it, > 0.
double magnitude_of(std::size_t half_octave);

// A split's surroundings, seen from the parent's place.
struct Surroundings {
  Vec3i parent{};
  std::array<Vec3d, 2> middle;       // of each child's neighbours without the other child
  Vec3d thirds{};                    // the middle of the vertices that both have
  Vec3d normal{};                    // of the ring, of unit length; or zero
  double mean_edge = 0;              // distance of the neighbours: |x| + |y| + |z|
  std::array<int, 3> axis{0, 1, 2};  // the last one nearest to the normal
  std::array<double, 2> slope{};     // of the tangent plane over the first two axes

  // Of a child whose sibling stays where the parent was.
  Vec3i beside_parent(bool second) const;
  // Of the second child when both leave, and then of the first.
  Vec3i second_of_both() const;
  Vec3i first_of_both(const Vec3i& second) const;

  // How far a step along the first two axes leads along the third in the tangent plane.
  std::int32_t shear(std::int32_t first, std::int32_t second) const;
};

// Of the children t and u; neither place is read.
Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent);

}  // namespace crease::codec
