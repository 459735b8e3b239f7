// A direction as a mixture: what its corner's triangles, its neighbours and the coarse end let it
// be. Coded like a place (place_mixture.h), on the square of octahedral codes. Floats without
// fused products.
//
//   DirectionMixture mixture = model.mixture(coding, candidates, sizes);
//   code = code_direction(coder, coding, mixture, code);
//   model.learn(mixture, sizes);
#pragma once

#include "codec/mixture_model.h"
#include "codec/place_mixture.h"
#include "codec/spot.h"
#include "mesh/octahedral.h"

#include <array>
#include <cstddef>

namespace crease::codec {

struct DirectionMixture {
  OctahedralCoding::Frame start;         // residuals are from here
  std::array<PerComponent, 2> center{};  // residuals
  PerComponent weight{}, scale{}, excess{};
};

// Where a direction may be; zero vectors are left out.
struct DirectionCandidates {
  std::array<Spot, kComponents> of{};
};

// Leaves in `mixture.weight` how likely each component was right.
template <class Coder>
OctahedralCode code_direction(Coder& coder, const OctahedralCoding& coding,
                              DirectionMixture& mixture, OctahedralCode code) {
  constexpr float kLeast = 0.1f;  // of scales, beside which the codes are coarse
  OctahedralResidual residual;
  if constexpr (Coder::kEncodes) residual = coding.residual(code, mixture.start);
  AxisMixture axis;
  axis.weight = mixture.weight;
  axis.center = mixture.center[0];
  const EightFloats scale(mixture.scale);
  EightFloats inverse = 1.0f / (scale + kLeast);
  inverse.store(axis.inverse_scale);
  residual.x = code_axis(coder, axis, 0, mixture.scale[0], residual.x);
  const float x = static_cast<float>(residual.x);
  EightFloats z = (x - EightFloats(axis.center)) * inverse;
  const EightFloats first_excess = excess(z * z, kLeast, inverse);
  inverse = 1.0f / (scale * root(0.5f + 0.5f * z * z) + kLeast);
  inverse.store(axis.inverse_scale);
  axis.center = mixture.center[1];
  residual.y = code_axis(coder, axis, 0, mixture.scale[0], residual.y);
  const float y = static_cast<float>(residual.y);
  z = (y - EightFloats(axis.center)) * inverse;
  (first_excess + excess(z * z, kLeast, inverse)).store(mixture.excess);
  mixture.weight = axis.weight;
  return coding.restore(residual, mixture.start);
}

class DirectionModel {
 public:
  // Of single corners, or of whole vertices.
  DirectionModel(bool of_corners, const LearningRates& rates);

  // The first candidate is where residuals start.
  DirectionMixture mixture(const OctahedralCoding& coding, const DirectionCandidates& candidates,
                           const Sizes& sizes) const;
  void learn(const DirectionMixture& mixture, const Sizes& sizes);

 private:
  float mean_rate_;
  ComponentWeights weights_;
  ComponentScales scales_;
  MeanSizes mean_;
};

}  // namespace crease::codec
