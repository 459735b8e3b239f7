// A direction as a mixture: what its corner's triangles, its neighbours and the coarse end let it
// be. Coded like a place (place_mixture.h), on the square of octahedral codes. Doubles without
// fused products.
//
//   DirectionMixture mixture = model.mixture(coding, candidates, sizes);
//   code = code_direction(coder, coding, mixture, code);
//   model.learn(mixture, sizes);
#pragma once

#include "codec/mixture_model.h"
#include "codec/place_mixture.h"
#include "mesh/octahedral.h"

#include <array>
#include <cstddef>

namespace crease::codec {

struct DirectionMixture {
  OctahedralCode start;                  // residuals are from here
  std::array<PerComponent, 2> center{};  // residuals
  PerComponent weight{}, scale{}, excess{};
};

// Where a direction may be; zero vectors are left out.
struct DirectionCandidates {
  std::array<Vec3d, kComponents> of{};
};

// Leaves in `mixture.weight` how likely each component was right.
template <class Coder>
OctahedralCode code_direction(Coder& coder, const OctahedralCoding& coding,
                              DirectionMixture& mixture, OctahedralCode code) {
  constexpr double kLeast = 0.1;  // of scales, beside which the codes are coarse
  OctahedralResidual residual;
  if constexpr (Coder::kEncodes) residual = coding.residual(code, mixture.start);
  AxisMixture axis;
  axis.weight = mixture.weight;
  axis.center = mixture.center[0];
  for (std::size_t k = 0; k < kComponents; ++k) {
    axis.inverse_scale[k] = 1 / (mixture.scale[k] + kLeast);
  }
  residual.x = code_axis(coder, axis, 0, mixture.scale[0], residual.x);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double z = (residual.x - axis.center[k]) * axis.inverse_scale[k];
    const double part = 1 - kLeast * axis.inverse_scale[k];
    mixture.excess[k] = excess(z * z) * part;
    axis.inverse_scale[k] = 1 / (mixture.scale[k] * std::sqrt(0.5 + 0.5 * z * z) + kLeast);
  }
  axis.center = mixture.center[1];
  residual.y = code_axis(coder, axis, 0, mixture.scale[0], residual.y);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const double z = (residual.y - axis.center[k]) * axis.inverse_scale[k];
    mixture.excess[k] += excess(z * z) * (1 - kLeast * axis.inverse_scale[k]);
  }
  mixture.weight = axis.weight;
  return coding.restore(residual, mixture.start);
}

class DirectionModel {
 public:
  // Of single corners, or of whole vertices.
  explicit DirectionModel(bool of_corners);

  // The first candidate is where residuals start.
  DirectionMixture mixture(const OctahedralCoding& coding, const DirectionCandidates& candidates,
                           const Sizes& sizes) const;
  void learn(const DirectionMixture& mixture, const Sizes& sizes);

 private:
  ComponentWeights weights_;
  ComponentScales scales_;
  MeanSizes mean_;
};

}  // namespace crease::codec
