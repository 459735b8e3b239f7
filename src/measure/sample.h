// Points on a surface, uniform by area, the same for any number of threads.
#pragma once

#include "measure/surface.h"

#include <array>
#include <cstdint>
#include <vector>

namespace crease {

struct SurfacePoint {
  std::size_t triangle = 0;
  std::array<double, 3> weights{};  // barycentric
};

// Cuts the surface, triangle after triangle, into `count` strips of equal area and draws one point
// in each. Point i depends on the surface, the seed and i alone.
class Sampler {
 public:
  Sampler(const Surface& surface, std::size_t count, std::uint32_t seed);
  SurfacePoint operator()(std::size_t i) const;

 private:
  std::vector<double> area_up_to_;  // triangle_count values, running sum
  std::size_t count_;
  std::uint32_t seed_;
};

}  // namespace crease
