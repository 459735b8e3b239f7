// What a child's place is like: which mixture to code it by, learned from those before. Floats
// without fused products, as in predict_position.h.
//
//   PlaceMixture mixture = model.mixture(around, second, triangles, ring, sizes);
//   place = code_place(coder, mixture, place);
//   model.learn(mixture, triangles, sizes);
//
// The components: the mean of the neighbours, weighed; on the way to them; then what a regular mesh
// would have: halfway between the sibling and the vertex opposite, parallelograms over the two
// triangles at the sibling, halfway between each third vertex and the one opposite; and where the
// parent was.
#pragma once

#include "codec/mixture_model.h"
#include "codec/place_mixture.h"
#include "codec/predict_position.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease::codec {

// Whose place is coded: a child whose sibling stays where the parent was; of two that leave the
// second, which comes first; then the first.
enum class Leaving : std::uint8_t { One, SecondOfBoth, FirstOfBoth, SecondBetween, FirstBetween };

// A child's neighbours, where they are one closed fan, from the parent's place.
struct ChildRing {
  std::span<const Spot> arc;     // without the sibling, in order; empty: they are no such fan
  std::array<Spot, 2> beyond{};  // what precedes and follows them at the sibling
  Spot sibling{};                // or zero where its place is not known
  float share = 0.5f;  // of the way between the two from the sibling to the parent, if it is known
};

// Of what the neighbours' misses, the edges and the bend lead to expect.
Sizes sizes(const Surroundings& around, const Miss& miss);

// What is known of the components, for one Leaving: it starts from what was found in many models
// and learns, within a block, where each place was.
class PlaceModel {
 public:
  PlaceModel(Leaving leaving, const LearningRates& rates);

  // Of a child with so many triangles.
  PlaceMixture mixture(const Surroundings& around, bool second, std::size_t triangles,
                       const ChildRing& ring, const Sizes& sizes) const;
  // The same one, after the place was coded.
  void learn(const PlaceMixture& mixture, std::size_t triangles, const Sizes& sizes);

 private:
  static constexpr std::size_t kTriangles = 6;  // 3 to 8 of them
  static std::size_t triangles_class(std::size_t triangles);

  Leaving leaving_;
  float mean_rate_;
  std::array<ComponentWeights, kTriangles> weights_;
  ComponentScales tangent_, normal_;
  MeanSizes mean_;
};

}  // namespace crease::codec
