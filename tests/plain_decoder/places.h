// docs/format-block.md, "Surroundings" and "Positions": where the children of a split may be.
#pragma once

#include "plain_decoder/around.h"
#include "plain_decoder/mixture.h"

#include <array>
#include <cstddef>
#include <vector>

namespace plain {

// Of a split, from where its vertex stood.
struct Surroundings {
  std::array<Vector, 2> middle;  // of the first and the second child
  Vector thirds, normal;
  double edge = 0, bend = 0;
  std::array<std::size_t, 3> axis{};
};
Surroundings surroundings(const Surface& surface, std::uint32_t first, std::uint32_t second,
                          const Point& s);

// How far from component 0 a vertex was found.
struct Miss {
  float tangent = 0, normal = 0;
};

Sizes sizes_of_place(const Surroundings& around, const Miss& expected);

enum class Who : std::size_t { One, SecondOfBoth, FirstOfBoth };  // moves

// A child, as the components see it; places are from where the parent stood.
struct Child {
  Who who = Who::One;
  bool second = false;
  std::size_t triangles = 0;
  Vector sibling;
  std::vector<Vector> ring;  // r_0, the sibling, r_1, ...; empty if no closed fan was split
  Vector before, after;
};

class PlaceModel {
 public:
  explicit PlaceModel(Who who);

  // The place along the three axes, less where the parent stood. Sets the child's new miss.
  std::array<std::int32_t, 3> read(RangeDecoder& in, const Surroundings& around, const Child& child,
                                   const Sizes& sizes, Miss& miss);

 private:
  std::array<ComponentWeights, 6> weights_;  // of 3 to 8 triangles
  ComponentScales tangent_, normal_;
  MeanSizes mean_;
};

}  // namespace plain
