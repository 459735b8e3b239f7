#include "codec/place_model.h"

#include "codec/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

// Weights of vectors, and of their parts along the normal beside that: least absolute residuals
// over scans, CAD and city models.
struct Weights {
  double own, other, thirds, sibling;  // middles, and the sibling where it is known
  double normal_own, normal_other, normal_thirds, normal_sibling;  // along the normal
};
constexpr Weights kWeights[] = {
    {0.785, -0.109, -0.253, 0, -0.488, 0.123, 0.045, 0},  // by Leaving
    {0.400, -0.146, -0.045, 0, -0.124, 0.234, -0.206, 0},
    {0.339, -0.111, -0.026, -0.150, -0.094, 0.337, -0.303, -0.170},
    {0.649, -0.545, -0.027, 0, -0.050, 0.675, -0.470, 0},  // for the whole way between the two
    {0.339, -0.111, -0.026, -0.150, -0.094, 0.337, -0.303, -0.170},
};

// What a block starts from, learned over scans, CAD and city models. How likely components are, by
// number of triangles from 3 to 8.
constexpr std::array<PerComponent, 6> kLikely[] = {
    {{{0.417, 0.360, 0.021, 0.071, 0.047, 0.001, 0.001, 0.116},
      {0.551, 0.102, 0.226, 0.021, 0.026, 0.023, 0.012, 0.043},
      {0.760, 0.072, 0.072, 0.016, 0.020, 0.014, 0.020, 0.028},
      {0.686, 0.049, 0.162, 0.016, 0.017, 0.026, 0.026, 0.021},
      {0.704, 0.150, 0.041, 0.014, 0.021, 0.011, 0.010, 0.051},
      {0.520, 0.187, 0.044, 0.034, 0.035, 0.024, 0.025, 0.154}}},
    {{{0.354, 0.321, 0.007, 0.001, 0.001, 0.016, 0.016, 0.315},
      {0.546, 0.217, 0.097, 0.001, 0.001, 0.005, 0.007, 0.128},
      {0.743, 0.124, 0.032, 0.001, 0.001, 0.002, 0.002, 0.097},
      {0.816, 0.036, 0.056, 0.001, 0.001, 0.002, 0.002, 0.087},
      {0.673, 0.106, 0.013, 0.001, 0.001, 0.001, 0.001, 0.208},
      {0.457, 0.123, 0.010, 0.001, 0.001, 0.001, 0.001, 0.413}}},
    {{{0.212, 0.363, 0.008, 0.002, 0.001, 0.012, 0.008, 0.415},
      {0.490, 0.235, 0.102, 0.001, 0.001, 0.004, 0.003, 0.169},
      {0.718, 0.150, 0.032, 0.001, 0.001, 0.005, 0.002, 0.094},
      {0.821, 0.028, 0.059, 0.001, 0.001, 0.001, 0.002, 0.089},
      {0.715, 0.063, 0.008, 0.001, 0.001, 0.001, 0.002, 0.212},
      {0.493, 0.051, 0.005, 0.001, 0.001, 0.001, 0.001, 0.451}}},
    {{{0.600, 0.169, 0.004, 0.001, 0.001, 0.005, 0.005, 0.225},
      {0.778, 0.084, 0.058, 0.001, 0.001, 0.001, 0.002, 0.077},
      {0.900, 0.034, 0.015, 0.001, 0.001, 0.001, 0.001, 0.050},
      {0.895, 0.012, 0.054, 0.001, 0.001, 0.001, 0.001, 0.039},
      {0.856, 0.050, 0.007, 0.001, 0.001, 0.001, 0.001, 0.088},
      {0.611, 0.084, 0.008, 0.001, 0.001, 0.001, 0.001, 0.298}}},
    {{{0.208, 0.471, 0.004, 0.001, 0.001, 0.006, 0.004, 0.313},
      {0.586, 0.207, 0.058, 0.001, 0.001, 0.002, 0.001, 0.146},
      {0.813, 0.095, 0.011, 0.001, 0.001, 0.001, 0.001, 0.079},
      {0.879, 0.026, 0.016, 0.001, 0.001, 0.001, 0.001, 0.079},
      {0.777, 0.042, 0.003, 0.001, 0.001, 0.001, 0.001, 0.178},
      {0.537, 0.051, 0.003, 0.001, 0.001, 0.001, 0.001, 0.410}}},
};
// The powers of two of how far off they are, in the tangent plane and along the normal; and how
// these grow with the sizes, of the first two components and of the others.
struct Scales {
  PerComponent tangent, normal;
  std::array<Sizes, 2> tangent_slope, normal_slope;
};
constexpr Scales kOne = {{-1.366, -0.838, -2.000, -7.777, -6.342, 0.009, -0.358, -0.665},
                         {-1.032, 0.866, -1.873, -8.525, -7.578, -0.115, -0.001, -1.059},
                         {{{0.340, 0.101, 0.453, 0.076}, {0.148, 0.206, 0.460, -0.362}}},
                         {{{-0.285, 0.561, -0.334, 0.963}, {-0.290, 0.419, -0.013, 0.502}}}};
constexpr Scales kSecond = {{-1.189, -0.681, -3.822, -1.903, -2.256, -2.647, -2.259, -2.468},
                            {-1.552, -0.022, -2.562, -1.663, -1.650, -1.567, -1.565, -3.406},
                            {{{0.329, 0.073, 0.375, 0.112}, {0.145, 0.081, 0.746, -0.208}}},
                            {{{-0.295, 0.669, -0.275, 0.845}, {-0.158, 0.306, 0.192, 0.454}}}};
constexpr Scales kFirst = {{-1.111, -0.577, -3.939, -2.098, -1.841, -1.997, -2.808, -2.437},
                           {-1.480, 0.022, -2.505, -1.659, -1.974, -1.694, -1.505, -3.905},
                           {{{0.380, 0.073, 0.346, 0.098}, {0.090, 0.119, 0.758, -0.174}}},
                           {{{-0.335, 0.759, -0.373, 0.913}, {-0.202, 0.332, 0.144, 0.582}}}};

const Scales& scales_of(Leaving leaving) {
  if (leaving == Leaving::One) return kOne;
  const bool is_second = leaving == Leaving::SecondOfBoth || leaving == Leaving::SecondBetween;
  return is_second ? kSecond : kFirst;
}

}  // namespace

Sizes sizes(const Surroundings& around, const Miss& miss) {
  return {rough_log2(miss.tangent + 0.25), rough_log2(miss.normal + 0.25),
          rough_log2(around.mean_edge + 1), rough_log2(around.bend + 1)};
}

PlaceModel::PlaceModel(Leaving leaving) : leaving_(leaving) {
  for (std::size_t c = 0; c < kTriangles; ++c) {
    weights_[c].of = kLikely[std::size_t(leaving)][c];
  }
  const Scales& start = scales_of(leaving);
  tangent_ = {start.tangent, start.tangent_slope};
  normal_ = {start.normal, start.normal_slope};
}

std::size_t PlaceModel::triangles_class(std::size_t triangles) {
  return std::clamp<std::size_t>(triangles, 3, kTriangles + 2) - 3;
}

PlaceMixture PlaceModel::mixture(const Surroundings& around, bool second, std::size_t triangles,
                                 const ChildRing& ring, const Sizes& sizes) const {
  const Weights& w = kWeights[std::size_t(leaving_)];
  const Vec3d &own = around.middle[second], &other = around.middle[!second], &n = around.normal;
  const double along = w.normal_own * dot(own, n) + w.normal_other * dot(other, n) +
                       w.normal_thirds * dot(around.thirds, n) +
                       w.normal_sibling * dot(ring.sibling, n);
  Vec3d mean = own * w.own + other * w.other + around.thirds * w.thirds + ring.sibling * w.sibling +
               n * along;
  Vec3d sibling = ring.sibling, second_guess = own * 0.6;
  const double away = 1 - ring.share;  // of the way between the two: to this one
  if (leaving_ == Leaving::SecondBetween) {
    mean = mean * away;
    sibling = mean * (-ring.share / away);
    second_guess = own * (1.2 * away);
  } else if (leaving_ == Leaving::FirstOfBoth || leaving_ == Leaving::FirstBetween) {
    second_guess = ring.sibling * (-away / ring.share);
  }

  PlaceMixture result;
  result.weight = weights_[triangles_class(triangles)].of;
  const std::array<int, 3>& axis = around.axis;
  if (n[axis[2]] != 0) result.direction = {n[axis[0]], n[axis[1]], n[axis[2]]};
  const auto expect = [&](std::size_t k, const Vec3d& place) {
    result.center[0][k] = place[axis[0]];
    result.center[1][k] = place[axis[1]];
    result.center[2][k] = place[axis[2]] - rise(result.direction, place[axis[0]], place[axis[1]]);
  };
  expect(0, mean);
  expect(1, second_guess);
  expect(7, {});
  const std::size_t arc = ring.arc.size(), all = arc + 1;
  if (arc > 0) {
    // Round the ring from the sibling on: halfway between vertices that are opposite, and
    // parallelograms over the triangles at the sibling.
    const auto at = [&](std::size_t i) { return i == 0 ? sibling : ring.arc[i - 1]; };
    expect(2, (at(0) + at(all / 2)) * 0.5);
    expect(3, ring.arc[arc - 1] + sibling - ring.beyond[1]);
    expect(4, ring.arc[0] + sibling - ring.beyond[0]);
    expect(5, (at(1) + at((1 + all / 2) % all)) * 0.5);
    expect(6, (at(all - 1) + at(all - 1 - all / 2)) * 0.5);
  } else {
    for (std::size_t k = 2; k < 7; ++k) result.weight[k] = 0;
  }

  result.tangent = tangent_.at(sizes);
  result.normal = normal_.at(sizes);
  if (leaving_ == Leaving::SecondBetween) {
    for (std::size_t k = 0; k < kComponents; ++k) {
      result.tangent[k] *= 2 * away;
      result.normal[k] *= 2 * away;
    }
  }
  return result;
}

void PlaceModel::learn(const PlaceMixture& mixture, std::size_t triangles, const Sizes& sizes) {
  PerComponent right = mixture.weight;
  if (!make_shares(right)) return;
  weights_[triangles_class(triangles)].learn(right);
  mean_.learn(sizes);
  tangent_.learn(right, mixture.tangent_excess, sizes, mean_.of);
  normal_.learn(right, mixture.normal_excess, sizes, mean_.of);
}

}  // namespace crease::codec
