#include "crease/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace crease {

Vec3i Grid::nearest(const Vec3d& p) const {
  return {static_cast<std::int32_t>(std::llround((p.x - origin.x) / step)),
          static_cast<std::int32_t>(std::llround((p.y - origin.y) / step)),
          static_cast<std::int32_t>(std::llround((p.z - origin.z) / step))};
}

Grid make_grid(const Mesh& mesh, const Precision& precision) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3d low{kInf, kInf, kInf}, high{-kInf, -kInf, -kInf};
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  if (mesh.positions.empty()) return {};
  const Vec3d size = high - low;
  const double longest = std::max({size.x, size.y, size.z});

  Grid grid;
  grid.step = precision.length > 0 ? precision.length : longest / double(1 << precision.bits);
  // Grid coordinates stay within 30 bits whatever length was asked for.
  grid.step = std::max(grid.step, longest / double(1 << 30));
  // And doubles tell its points apart however far away they are.
  for (int i = 0; i < 3; ++i) {
    const double away = std::max(std::abs(low[i]), std::abs(high[i]));
    grid.step = std::max(grid.step, std::ldexp(away, -49));
  }
  if (!(grid.step > 0)) grid.step = 1;
  for (int i = 0; i < 3; ++i) {
    grid.origin[i] = std::round((low[i] + 0.5 * size[i]) / grid.step) * grid.step;
  }
  return grid;
}

void snap(Mesh& mesh, const Grid& grid) {
  for (Vec3d& p : mesh.positions) p = grid.position(grid.nearest(p));
}

}  // namespace crease
