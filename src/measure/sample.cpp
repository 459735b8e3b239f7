#include "measure/sample.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

// splitmix64, as a hash: 0 <= result < 1.
double random(std::uint64_t seed, std::uint64_t i) {
  std::uint64_t z = (seed << 40 ^ seed >> 24) + (i + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

Sampler::Sampler(const Surface& surface, std::size_t count, std::uint32_t seed)
    : count_(count), seed_(seed) {
  area_up_to_.reserve(surface.triangle_count());
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    const Vec3d a = surface.corner(t, 0);
    sum += 0.5 * length(cross(surface.corner(t, 1) - a, surface.corner(t, 2) - a));
    area_up_to_.push_back(sum);
  }
  if (sum > 0) return;
  // Nothing but lines and points: each counts the same.
  for (std::size_t t = 0; t < area_up_to_.size(); ++t) area_up_to_[t] = double(t + 1);
}

SurfacePoint Sampler::operator()(std::size_t i) const {
  const double area = area_up_to_.back() * ((double(i) + random(seed_, 3 * i)) / double(count_));
  const auto found = std::upper_bound(area_up_to_.begin(), area_up_to_.end() - 1, area);
  const double r = std::sqrt(random(seed_, 3 * i + 1)), s = random(seed_, 3 * i + 2);
  return {.triangle = std::size_t(found - area_up_to_.begin()),
          .weights = {1 - r, r * (1 - s), r * s}};
}

}  // namespace crease
