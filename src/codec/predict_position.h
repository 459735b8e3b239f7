// Where the two children of a split are expected, from the triangles that they have. Doubles
// without fused products: encoder and decoder get the same to the bit on every machine.
#pragma once

#include "codec/patch_mesh.h"
#include "codec/place_mixture.h"

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

// How far from where its neighbours had it a vertex was found, in its tangent plane and along the
// normal; below zero: it was not looked for.
struct Miss {
  float tangent = -1, normal = -1;
};

// Whose place is coded: a child whose sibling stays where the parent was; of two that leave the
// second, which comes first; then the first.
enum class Leaving : std::uint8_t { One, SecondOfBoth, FirstOfBoth };

// A split's surroundings, seen from the parent's place.
struct Surroundings {
  Vec3i parent{};
  std::array<Vec3d, 2> middle;       // of each child's neighbours without the other child
  Vec3d thirds{};                    // the middle of the vertices that both have
  Vec3d normal{};                    // of the ring, of unit length; or zero
  double mean_edge = 0;              // distance of the neighbours: |x| + |y| + |z|
  double bend = 0;                   // how far that leads from one child's plane to the other's
  std::array<int, 3> axis{0, 1, 2};  // the last one nearest to the normal
};

// Of the children t and u; neither place is read.
Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent);

// A child's neighbours, where they are one closed fan, from the parent's place.
struct ChildRing {
  std::span<const Vec3d> arc;     // without the sibling, in order; empty: they are no such fan
  std::array<Vec3d, 2> beyond{};  // what precedes and follows them at the sibling
  Vec3d sibling{};                // or zero where its place is not known
};

// `miss`: what to expect by the neighbours; `weights`: of the components beforehand.
PlaceMixture place_mixture(const Surroundings& around, Leaving leaving, bool second,
                           const ChildRing& ring, const Miss& miss, const PerComponent& weights);

// How likely each component is: moves towards what was right, an AdaptiveBit with more sides.
struct PlaceWeights {
  PerComponent of{};
  int seen = 0;

  void learn(const PerComponent& right) {
    double sum = 0;
    for (const double x : right) sum += x;
    if (!(sum > 0)) return;
    const double rate = 1.0 / (std::min(seen++, 200) + 40);
    for (std::size_t k = 0; k < kComponents; ++k) of[k] += rate * (right[k] / sum - of[k]);
  }
};
using PlaceWeightsByChild = std::array<std::array<PlaceWeights, 6>, 3>;
PlaceWeightsByChild known_place_weights();

}  // namespace crease::codec
