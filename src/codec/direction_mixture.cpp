#include "codec/direction_mixture.h"

namespace crease::codec {

DirectionModel::DirectionModel() {
  weights_.of = {0.3, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
  scales_.of = {0, 0, 0, 0, 0, 0, 0, 0};
  scales_.slope = {{{0.5, 0.3, 0, 0}, {0.5, 0.3, 0, 0}}};
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
