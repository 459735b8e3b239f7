#include "codec/place_model.h"

#include "base/wide.h"
#include "codec/deterministic_math.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crease::codec {

namespace {

// Weights of vectors, and of their parts along the normal beside that: least absolute residuals
// over scans, CAD and city models.
struct Weights {
  float own, other, thirds, sibling;  // middles, and the sibling where it is known
  float normal_own, normal_other, normal_thirds, normal_sibling;  // along the normal
};
constexpr Weights kWeights[] = {
    {0.785f, -0.109f, -0.253f, 0, -0.488f, 0.123f, 0.045f, 0},  // by Leaving
    {0.400f, -0.146f, -0.045f, 0, -0.124f, 0.234f, -0.206f, 0},
    {0.339f, -0.111f, -0.026f, -0.150f, -0.094f, 0.337f, -0.303f, -0.170f},
    {0.649f, -0.545f, -0.027f, 0, -0.050f, 0.675f, -0.470f,
     0},  // for the whole way between the two
    {0.339f, -0.111f, -0.026f, -0.150f, -0.094f, 0.337f, -0.303f, -0.170f},
};

// What a block starts from, learned over scans, CAD and city models. How likely components are, by
// number of triangles from 3 to 8.
constexpr std::array<PerComponent, 6> kLikely[] = {
    {{{0.417f, 0.360f, 0.021f, 0.071f, 0.047f, 0.001f, 0.001f, 0.116f},
      {0.551f, 0.102f, 0.226f, 0.021f, 0.026f, 0.023f, 0.012f, 0.043f},
      {0.760f, 0.072f, 0.072f, 0.016f, 0.020f, 0.014f, 0.020f, 0.028f},
      {0.686f, 0.049f, 0.162f, 0.016f, 0.017f, 0.026f, 0.026f, 0.021f},
      {0.704f, 0.150f, 0.041f, 0.014f, 0.021f, 0.011f, 0.010f, 0.051f},
      {0.520f, 0.187f, 0.044f, 0.034f, 0.035f, 0.024f, 0.025f, 0.154f}}},
    {{{0.354f, 0.321f, 0.007f, 0.001f, 0.001f, 0.016f, 0.016f, 0.315f},
      {0.546f, 0.217f, 0.097f, 0.001f, 0.001f, 0.005f, 0.007f, 0.128f},
      {0.743f, 0.124f, 0.032f, 0.001f, 0.001f, 0.002f, 0.002f, 0.097f},
      {0.816f, 0.036f, 0.056f, 0.001f, 0.001f, 0.002f, 0.002f, 0.087f},
      {0.673f, 0.106f, 0.013f, 0.001f, 0.001f, 0.001f, 0.001f, 0.208f},
      {0.457f, 0.123f, 0.010f, 0.001f, 0.001f, 0.001f, 0.001f, 0.413f}}},
    {{{0.212f, 0.363f, 0.008f, 0.002f, 0.001f, 0.012f, 0.008f, 0.415f},
      {0.490f, 0.235f, 0.102f, 0.001f, 0.001f, 0.004f, 0.003f, 0.169f},
      {0.718f, 0.150f, 0.032f, 0.001f, 0.001f, 0.005f, 0.002f, 0.094f},
      {0.821f, 0.028f, 0.059f, 0.001f, 0.001f, 0.001f, 0.002f, 0.089f},
      {0.715f, 0.063f, 0.008f, 0.001f, 0.001f, 0.001f, 0.002f, 0.212f},
      {0.493f, 0.051f, 0.005f, 0.001f, 0.001f, 0.001f, 0.001f, 0.451f}}},
    {{{0.600f, 0.169f, 0.004f, 0.001f, 0.001f, 0.005f, 0.005f, 0.225f},
      {0.778f, 0.084f, 0.058f, 0.001f, 0.001f, 0.001f, 0.002f, 0.077f},
      {0.900f, 0.034f, 0.015f, 0.001f, 0.001f, 0.001f, 0.001f, 0.050f},
      {0.895f, 0.012f, 0.054f, 0.001f, 0.001f, 0.001f, 0.001f, 0.039f},
      {0.856f, 0.050f, 0.007f, 0.001f, 0.001f, 0.001f, 0.001f, 0.088f},
      {0.611f, 0.084f, 0.008f, 0.001f, 0.001f, 0.001f, 0.001f, 0.298f}}},
    {{{0.208f, 0.471f, 0.004f, 0.001f, 0.001f, 0.006f, 0.004f, 0.313f},
      {0.586f, 0.207f, 0.058f, 0.001f, 0.001f, 0.002f, 0.001f, 0.146f},
      {0.813f, 0.095f, 0.011f, 0.001f, 0.001f, 0.001f, 0.001f, 0.079f},
      {0.879f, 0.026f, 0.016f, 0.001f, 0.001f, 0.001f, 0.001f, 0.079f},
      {0.777f, 0.042f, 0.003f, 0.001f, 0.001f, 0.001f, 0.001f, 0.178f},
      {0.537f, 0.051f, 0.003f, 0.001f, 0.001f, 0.001f, 0.001f, 0.410f}}},
};
// The powers of two of how far off they are, in the tangent plane and along the normal; and how
// these grow with the sizes, of the first two components and of the others.
struct Scales {
  PerComponent tangent, normal;
  std::array<Sizes, 2> tangent_slope, normal_slope;
};
constexpr Scales kOne = {
    {-1.366f, -0.838f, -2.000f, -7.777f, -6.342f, 0.009f, -0.358f, -0.665f},
    {-1.032f, 0.866f, -1.873f, -8.525f, -7.578f, -0.115f, -0.001f, -1.059f},
    {{{0.340f, 0.101f, 0.453f, 0.076f}, {0.148f, 0.206f, 0.460f, -0.362f}}},
    {{{-0.285f, 0.561f, -0.334f, 0.963f}, {-0.290f, 0.419f, -0.013f, 0.502f}}}};
constexpr Scales kSecond = {
    {-1.189f, -0.681f, -3.822f, -1.903f, -2.256f, -2.647f, -2.259f, -2.468f},
    {-1.552f, -0.022f, -2.562f, -1.663f, -1.650f, -1.567f, -1.565f, -3.406f},
    {{{0.329f, 0.073f, 0.375f, 0.112f}, {0.145f, 0.081f, 0.746f, -0.208f}}},
    {{{-0.295f, 0.669f, -0.275f, 0.845f}, {-0.158f, 0.306f, 0.192f, 0.454f}}}};
constexpr Scales kFirst = {
    {-1.111f, -0.577f, -3.939f, -2.098f, -1.841f, -1.997f, -2.808f, -2.437f},
    {-1.480f, 0.022f, -2.505f, -1.659f, -1.974f, -1.694f, -1.505f, -3.905f},
    {{{0.380f, 0.073f, 0.346f, 0.098f}, {0.090f, 0.119f, 0.758f, -0.174f}}},
    {{{-0.335f, 0.759f, -0.373f, 0.913f}, {-0.202f, 0.332f, 0.144f, 0.582f}}}};

const Scales& scales_of(Leaving leaving) {
  if (leaving == Leaving::One) return kOne;
  const bool is_second = leaving == Leaving::SecondOfBoth || leaving == Leaving::SecondBetween;
  return is_second ? kSecond : kFirst;
}

// Places along the axes of the surroundings; along the third, above the tangent plane.
[[gnu::always_inline]] inline void expect(const std::array<Spot, kComponents>& places,
                                          const Surroundings& around, PlaceMixture& result) {
  const std::array<EightFloats, 3> along = coordinates_of(places);
  const std::array<int, 3>& axis = around.axis;
  const Spot& n = around.normal;
  if (n[axis[2]] != 0) result.direction = {n[axis[0]], n[axis[1]], n[axis[2]]};
  const EightFloats &first = along[std::size_t(axis[0])], &second = along[std::size_t(axis[1])];
  const EightFloats& third = along[std::size_t(axis[2])];
  first.store(result.center[0]);
  second.store(result.center[1]);
  (third - rise(result.direction, first, second)).store(result.center[2]);
}

}  // namespace

Sizes sizes(const Surroundings& around, const Miss& miss) {
  return std::bit_cast<Sizes>(rough_log2_of_each(FourFloats{
      miss.tangent + 0.25f, miss.normal + 0.25f, around.mean_edge + 1, around.bend + 1}));
}

PlaceModel::PlaceModel(Leaving leaving, const LearningRates& rates)
    : leaving_(leaving), mean_rate_(rates.mean_sizes) {
  for (std::size_t c = 0; c < kTriangles; ++c) {
    weights_[c].of = kLikely[std::size_t(leaving)][c];
  }
  const Scales& start = scales_of(leaving);
  tangent_ = {start.tangent, start.tangent_slope, rates.place_slopes, rates.first_scales};
  normal_ = {start.normal, start.normal_slope, rates.place_slopes, rates.first_scales};
}

std::size_t PlaceModel::triangles_class(std::size_t triangles) {
  return std::clamp<std::size_t>(triangles, 3, kTriangles + 2) - 3;
}

CREASE_WIDE PlaceMixture PlaceModel::mixture(const Surroundings& around, bool second,
                                             std::size_t triangles, const ChildRing& ring,
                                             const Sizes& sizes) const {
  const Weights& w = kWeights[std::size_t(leaving_)];
  const Spot &own = around.middle[second], &other = around.middle[!second], &n = around.normal;
  const float along = w.normal_own * dot(own, n) + w.normal_other * dot(other, n) +
                      w.normal_thirds * dot(around.thirds, n) +
                      w.normal_sibling * dot(ring.sibling, n);
  Spot mean = own * w.own + other * w.other + around.thirds * w.thirds + ring.sibling * w.sibling +
              n * along;
  Spot sibling = ring.sibling, second_guess = own * 0.6f;
  const float away = 1 - ring.share;  // of the way between the two: to this one
  if (leaving_ == Leaving::SecondBetween) {
    mean = mean * away;
    sibling = mean * (-ring.share / away);
    second_guess = own * (1.2f * away);
  } else if (leaving_ == Leaving::FirstOfBoth || leaving_ == Leaving::FirstBetween) {
    second_guess = ring.sibling * (-away / ring.share);
  }

  PlaceMixture result;
  result.weight = weights_[triangles_class(triangles)].of;
  std::array<Spot, kComponents> expected{mean, second_guess};
  const std::size_t arc = ring.arc.size(), all = arc + 1;
  if (arc > 0) {
    // Round the ring from the sibling on: halfway between vertices that are opposite, and
    // parallelograms over the triangles at the sibling.
    const auto at = [&](std::size_t i) { return i == 0 ? sibling : ring.arc[i - 1]; };
    const std::size_t half = all / 2, over = 1 + half;
    expected[2] = (sibling + at(half)) * 0.5f;
    expected[3] = ring.arc[arc - 1] + sibling - ring.beyond[1];
    expected[4] = ring.arc[0] + sibling - ring.beyond[0];
    expected[5] = (ring.arc[0] + at(over < all ? over : over - all)) * 0.5f;
    expected[6] = (at(all - 1) + at(all - 1 - half)) * 0.5f;
  } else {
    for (std::size_t k = 2; k < 7; ++k) result.weight[k] = 0;
  }
  expect(expected, around, result);

  EightFloats tangent(tangent_.at(sizes)), normal(normal_.at(sizes));
  if (leaving_ == Leaving::SecondBetween) {
    tangent = tangent * (2 * away);
    normal = normal * (2 * away);
  }
  tangent.store(result.tangent);
  normal.store(result.normal);
  return result;
}

void PlaceModel::learn(const PlaceMixture& mixture, std::size_t triangles, const Sizes& sizes) {
  PerComponent right = mixture.weight;
  if (!make_shares(right)) return;
  weights_[triangles_class(triangles)].learn(right);
  mean_.learn(sizes, mean_rate_);
  tangent_.learn(right, mixture.tangent_excess, sizes, mean_.of);
  normal_.learn(right, mixture.normal_excess, sizes, mean_.of);
}

}  // namespace crease::codec
