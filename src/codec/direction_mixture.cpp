#include "codec/direction_mixture.h"

namespace crease::codec {

namespace {

// What a block starts from, learned over scans, CAD and city models: see place_model.cpp.
struct DirectionStart {
  PerComponent weights, scale;
  std::array<Sizes, 2> slope;
};
constexpr DirectionStart kOfVertices = {
    {0.157, 0.079, 0.008, 0.029, 0.021, 0.150, 0.501, 0.055},
    {3.056, 2.395, -0.518, 0.166, -0.108, -0.287, 2.704, 0.894},
    {{{0.314, 0.251, 0.084, -0.075}, {0.194, 0.132, 0.119, -0.076}}}};
constexpr DirectionStart kOfCorners = {
    {0.273, 0.231, 0.037, 0.247, 0.063, 0.037, 0.062, 0.050},
    {6.823, 5.426, 2.401, 4.111, 2.441, 1.739, 2.336, 2.020},
    {{{0.381, 0.305, -0.288, 0.123}, {0.370, 0.253, -0.118, 0.031}}}};

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
  result.start = coding.encode(candidates.of[0]);
  for (std::size_t k = 0; k < kComponents; ++k) {
    if (candidates.of[k] == Vec3d{}) {
      result.weight[k] = 0;
      continue;
    }
    const std::array<double, 2> off = coding.residual_of(candidates.of[k], result.start);
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
