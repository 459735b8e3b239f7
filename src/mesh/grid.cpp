#include "crease/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

namespace crease {

Vec3i Grid::nearest(const Vec3d& p) const {
  return {static_cast<std::int32_t>(std::llround((p.x - origin.x) / step)),
          static_cast<std::int32_t>(std::llround((p.y - origin.y) / step)),
          static_cast<std::int32_t>(std::llround((p.z - origin.z) / step))};
}

namespace {

struct Box {
  Vec3d low, size;
  double longest = 0;
};

Box box_of(const std::vector<Vec3d>& positions) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  if (positions.empty()) return {};
  Vec3d low{kInf, kInf, kInf}, high{-kInf, -kInf, -kInf};
  for (const Vec3d& p : positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  const Vec3d size = high - low;
  return {low, size, std::max({size.x, size.y, size.z})};
}

}  // namespace

Status check_precision(const Mesh& mesh, const Precision& precision) {
  constexpr double kFewestSteps = 16;
  const double longest = box_of(mesh.positions).longest;
  if (!(longest > 0) || precision.length * kFewestSteps <= longest) return Done{};
  char text[200];
  std::snprintf(text, sizeof text,
                "a precision of %g: the longest side is %g, of which that leaves next to nothing",
                precision.length, longest);
  std::string message = text;
  const double bits = precision.length;
  if (bits == std::floor(bits) && bits <= 30) {
    std::snprintf(text, sizeof text, "; %gbits is a grid of 2^%g steps over that side", bits, bits);
    message += text;
  }
  return fail(Error::CommandLine, message);
}

Grid make_grid(const Mesh& mesh, const Precision& precision) {
  if (mesh.positions.empty()) return {};
  const auto [low, size, longest] = box_of(mesh.positions);
  Grid grid;
  grid.step = precision.length > 0 ? precision.length : longest / double(1 << precision.bits);
  // Grid coordinates stay within 30 bits whatever length was asked for.
  grid.step = std::max(grid.step, longest / double(1 << 30));
  // And doubles tell its points apart however far away they are.
  for (int i = 0; i < 3; ++i) {
    const double away = std::max(std::abs(low[i]), std::abs(low[i] + size[i]));
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
