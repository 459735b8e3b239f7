#include "codec/direction_mixture.h"

#include "base/wide.h"

namespace crease::codec {

namespace {

// What a block starts from, learned over scans, CAD and city models: see place_model.cpp.
struct DirectionStart {
  PerComponent weights, scale;
  std::array<Sizes, 2> slope;
};
constexpr DirectionStart kOfVertices = {
    {0.157f, 0.079f, 0.008f, 0.029f, 0.021f, 0.150f, 0.501f, 0.055f},
    {3.056f, 2.395f, -0.518f, 0.166f, -0.108f, -0.287f, 2.704f, 0.894f},
    {{{0.314f, 0.251f, 0.084f, -0.075f}, {0.194f, 0.132f, 0.119f, -0.076f}}}};
constexpr DirectionStart kOfCorners = {
    {0.273f, 0.231f, 0.037f, 0.247f, 0.063f, 0.037f, 0.062f, 0.050f},
    {6.823f, 5.426f, 2.401f, 4.111f, 2.441f, 1.739f, 2.336f, 2.020f},
    {{{0.381f, 0.305f, -0.288f, 0.123f}, {0.370f, 0.253f, -0.118f, 0.031f}}}};

// Where directions lie on the square, on the half that is inside and on the one outside.
struct OnSquare {
  std::array<EightFloats, 2> inner, outer;
  EightInts is_below, is_any;  // z < 0; no zero vector
};

[[gnu::always_inline]] inline OnSquare on_square(const std::array<EightFloats, 3>& along, float m) {
  const auto& [x, y, z] = along;
  const EightFloats sum = size_of(x) + size_of(y) + size_of(z), unit = EightFloats(m) / sum;
  const EightFloats px = x * unit, py = y * unit;
  return {{px, py},
          {with_sign_of(m - size_of(py), px), with_sign_of(m - size_of(px), py)},
          EightFloats(0.0f) > z,
          sum > EightFloats(0.0f)};
}

// Of the first of them.
OctahedralCode code_near_first(const OctahedralCoding& coding, const OnSquare& of) {
  if (of.is_any.low[0] == 0) return OctahedralCoding::kZero;
  const std::array<EightFloats, 2>& p = of.is_below.low[0] != 0 ? of.outer : of.inner;
  return coding.near(p[0].low[0], p[1].low[0]);
}

}  // namespace

DirectionModel::DirectionModel(bool of_corners, const LearningRates& rates)
    : mean_rate_(rates.mean_sizes) {
  const DirectionStart& start = of_corners ? kOfCorners : kOfVertices;
  weights_.of = start.weights;
  scales_ = {start.scale, start.slope, rates.direction_slopes, rates.first_scales};
}

CREASE_WIDE DirectionMixture DirectionModel::mixture(const OctahedralCoding& coding,
                                                     const DirectionCandidates& candidates,
                                                     const Sizes& sizes) const {
  DirectionMixture result;
  const float m = static_cast<float>(coding.max_component() / 2);
  const OnSquare of = on_square(coordinates_of(candidates.of), m);
  result.start = coding.frame_of(code_near_first(coding, of));
  const auto& start = result.start;
  const EightInts is_over = of.is_below ^ (start.flip ? -1 : 0);
  EightFloats x = chosen(is_over, of.outer[0], of.inner[0]);
  EightFloats y = chosen(is_over, of.outer[1], of.inner[1]);
  if (start.turns & 1) {
    const EightFloats was = x;
    x = 0.0f - y;
    y = was;
  }
  if (start.turns & 2) {
    x = 0.0f - x;
    y = 0.0f - y;
  }
  (of.is_any & (x - static_cast<float>(start.predicted.x))).store(result.center[0]);
  (of.is_any & (y - static_cast<float>(start.predicted.y))).store(result.center[1]);
  (of.is_any & EightFloats(weights_.of)).store(result.weight);
  result.scale = scales_.at(sizes);
  return result;
}

void DirectionModel::learn(const DirectionMixture& mixture, const Sizes& sizes) {
  PerComponent right = mixture.weight;
  if (!make_shares(right)) return;
  weights_.learn(right);
  mean_.learn(sizes, mean_rate_);
  scales_.learn(right, mixture.excess, sizes, mean_.of);
}

}  // namespace crease::codec
