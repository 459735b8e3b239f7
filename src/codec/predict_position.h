// Where the two children of a split are expected, from the triangles that they have. Floats without
// fused products: encoder and decoder get the same to the bit on every machine.
#pragma once

#include "codec/patch_mesh.h"
#include "codec/spot.h"

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

// From a parent along the axes of its surroundings.
using Step = std::array<std::int32_t, 3>;

// How far from where its neighbours had it a vertex was found, in its tangent plane and along the
// normal.
struct Miss {
  float tangent = 0, normal = 0;
};

// A split's surroundings, seen from the parent's place.
struct Surroundings {
  Vec3i parent{};
  std::array<Spot, 2> middle{};      // of each child's neighbours without the other child
  Spot thirds{};                     // the middle of the vertices that both have
  Spot normal{};                     // of the ring, of unit length; or zero
  float mean_edge = 0;               // distance of the neighbours: |x| + |y| + |z|
  float bend = 0;                    // how far that leads from one child's plane to the other's
  std::array<int, 3> axis{0, 1, 2};  // the last one nearest to the normal
};

inline Step from_parent(const Surroundings& around, const Vec3i& place) {
  Step step;
  for (std::size_t i = 0; i < 3; ++i) {
    step[i] = wrapped_difference(place[around.axis[i]], around.parent[around.axis[i]]);
  }
  return step;
}
inline Vec3i beside_parent(const Surroundings& around, const Step& step) {
  Vec3i place;
  for (std::size_t i = 0; i < 3; ++i) {
    place[around.axis[i]] = wrapped_sum(around.parent[around.axis[i]], step[i]);
  }
  return place;
}

// Of the children t and u; neither place is read.
Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent);

// The same of a split of a fan whose vertices are at `places`, from the parent's place, the first
// one at the end again where it is closed: triangles [first, last) went to u, and there is one new
// one at the vertex `last` and, unless `single`, one at `first`.
Surroundings surroundings_in_fan(std::span<const Spot> places, std::size_t first, std::size_t last,
                                 bool single, const Vec3i& parent);

}  // namespace crease::codec
