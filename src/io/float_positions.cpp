#include "io/float_positions.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

// 2^-20: what floats are off by where a model is 16 times its size from the origin.
constexpr double kVisible = 1.0 / (1 << 20);

struct Bounds {
  Vec3d low, high;
  Vec3d middle() const { return low + (high - low) * 0.5; }
  double longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

Bounds bounds_of(const Mesh& mesh) {
  if (mesh.positions.empty()) return {};
  Bounds bounds{mesh.positions[0], mesh.positions[0]};
  for (const Vec3d& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      bounds.low[k] = std::min(bounds.low[k], p[k]);
      bounds.high[k] = std::max(bounds.high[k], p[k]);
    }
  }
  return bounds;
}

// Powers of ten are exact as products, down to one, and below it one over them.
double power_of_ten_from(double least) {
  double power = 1;
  if (least > 1) {
    while (power < least) power *= 10;
    return power;
  }
  double inverse = 1;
  while (1 / (inverse * 10) >= least) inverse *= 10;
  return 1 / inverse;
}

}  // namespace

double float_rounding(const Mesh& mesh, const Vec3d& origin) {
  double square = 0;
  for (const Vec3d& p : mesh.positions) {
    const Vec3d from_origin = p - origin;
    Vec3d off;
    for (int k = 0; k < 3; ++k) {
      off[k] = double(static_cast<float>(from_origin[k])) - from_origin[k];
    }
    square = std::max(square, dot(off, off));
  }
  return std::sqrt(square);
}

Vec3d middle_origin(const Mesh& mesh) {
  return float_rounding(mesh, {}) == 0 ? Vec3d{} : bounds_of(mesh).middle();
}

Vec3d round_origin(const Mesh& mesh) {
  const Bounds bounds = bounds_of(mesh);
  const double side = bounds.longest_side();
  if (!(side > 0) || float_rounding(mesh, {}) <= kVisible * side) return {};
  const double step = power_of_ten_from(side);
  Vec3d origin;
  for (int k = 0; k < 3; ++k) {
    // As short as it is round: 0.01 is no float, a hundred is one.
    const double per_unit = std::round(1 / step), steps = std::round(bounds.middle()[k] / step);
    origin[k] = (step < 1 ? steps / per_unit : step * steps) + 0.0;
  }
  return origin;
}

}  // namespace crease
