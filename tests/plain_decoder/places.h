// docs/format-block.md, "Surroundings" and "Positions": where the children of a split may be.
#pragma once

#include "plain_decoder/around.h"
#include "plain_decoder/mixture.h"
#include "plain_decoder/seen.h"

#include <array>
#include <cstddef>
#include <vector>

namespace plain {

// Of a split, from where its vertex stood.
struct Surroundings {
  std::array<FloatVector, 2> middle;  // of the first and the second child
  FloatVector thirds, normal;
  float edge = 0, bend = 0;
  std::array<std::size_t, 3> axis{};
};
Surroundings surroundings(const Surface& surface, std::uint32_t first, std::uint32_t second,
                          const Point& s);

// How far from component 0 a vertex was found.
struct Miss {
  float tangent = 0, normal = 0;
};

Sizes sizes_of_place(const Surroundings& around, const Miss& expected);

enum class Who : std::size_t {  // moves
  One,
  SecondOfBoth,
  FirstOfBoth,
  SecondBetween,
  FirstBetween
};

// A child, as the components see it; places are from where the parent stood.
struct Child {
  Who who = Who::One;
  bool second = false;
  std::size_t triangles = 0;
  FloatVector sibling;
  std::vector<FloatVector> ring;  // r_0, the sibling, r_1, ...; empty if no closed fan was split
  FloatVector before, after;
  float share = 0;  // of a second or first between
};

// The steps of a first between: which axis they go along, "gain" and "offset".
struct Steps {
  std::size_t axis = 2;
  float gain = 0, offset = 0;
};

class PlaceModel {
 public:
  PlaceModel(Who who, const Rates& rates);

  // The child's place. Sets its new miss.
  Along read(RangeDecoder& in, const Surroundings& around, const Child& child, const Sizes& sizes,
             SeenPlace& seen, Miss& miss);
  // Of a first between: how many steps, when `place` is known along the other two axes. `finish`
  // makes it known along the third, given the steps.
  template <class Finish>
  Along read_steps(RangeDecoder& in, const Surroundings& around, const Child& child,
                   const Sizes& sizes, const Steps& steps, Along place, Finish finish, Miss& miss) {
    Expected expected = expect(around, child, sizes);
    const std::int32_t count = read_count(in, expected, steps, place);
    place[steps.axis] = finish(count);
    learn(child, expected, sizes);
    miss = miss_of(expected, place);
    return place;
  }

 private:
  // What the components expect, and afterwards what they learn from.
  struct Expected {
    std::array<float, 3> D{0, 0, 1};  // the normal along the three axes
    PerComponent weight{}, T{}, N{};
    std::array<PerComponent, 3> centre{};
    PerComponent tangent_excess{}, normal_excess{};
  };
  Expected expect(const Surroundings& around, const Child& child, const Sizes& sizes) const;
  static std::int32_t read_count(RangeDecoder& in, Expected& expected, const Steps& steps,
                                 const Along& place);
  void learn(const Child& child, const Expected& expected, const Sizes& sizes);
  static Miss miss_of(const Expected& expected, const Along& place);
  static std::size_t weights_of(const Child& child);

  std::array<ComponentWeights, 6> weights_;  // of 3 to 8 triangles
  ComponentScales tangent_, normal_;
  MeanSizes mean_;
};

}  // namespace plain
