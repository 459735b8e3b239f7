#include "codec/direction_mixture.h"

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

}  // namespace

DirectionModel::DirectionModel(bool of_corners) {
  const DirectionStart& start = of_corners ? kOfCorners : kOfVertices;
  weights_.of = start.weights;
  scales_ = {start.scale, start.slope};
}

DirectionMixture DirectionModel::mixture(const OctahedralCoding& coding,
                                         const DirectionCandidates& candidates,
                                         const Sizes& sizes) const {
  DirectionMixture result;
  result.weight = weights_.of;
  result.scale = scales_.at(sizes);
  result.start = coding.frame_of(coding.near(candidates.of[0]));
  for (std::size_t k = 0; k < kComponents; ++k) {
    if (candidates.of[k] == Vec3d{}) {
      result.weight[k] = 0;
      continue;
    }
    const std::array<float, 2> off = coding.residual_of(candidates.of[k], result.start);
    result.center[0][k] = off[0];
    result.center[1][k] = off[1];
  }
  return result;
}

void DirectionModel::learn(const DirectionMixture& mixture, const Sizes& sizes) {
  PerComponent right = mixture.weight;
  if (!make_shares(right)) return;
  weights_.learn(right);
  mean_.learn(sizes);
  scales_.learn(right, mixture.excess, sizes, mean_.of);
}

}  // namespace crease::codec
