#include "crease/mesh.h"
#include "mesh/box_of.h"
#include "mesh/own_grid.h"
#include "mesh/strays.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace crease {

Vec3i Grid::nearest(const Vec3d& p) const {
  return {static_cast<std::int32_t>(std::llround((p.x - origin.x) / step)),
          static_cast<std::int32_t>(std::llround((p.y - origin.y) / step)),
          static_cast<std::int32_t>(std::llround((p.z - origin.z) / step))};
}

double finest_step(const Mesh& mesh) {
  const PointBox box = box_of(mesh.positions);
  // Grid coordinates stay within 30 bits.
  double step = box.longest / double(1 << 30);
  // And doubles tell its points apart however far away they are.
  for (int i = 0; i < 3; ++i) {
    const double away = std::max(std::abs(box.low[i]), std::abs(box.low[i] + box.size[i]));
    step = std::max(step, std::ldexp(away, -49));
  }
  return step;
}

Status check_precision(const Mesh& mesh, const Precision& precision) {
  constexpr double kFewestSteps = 16;
  constexpr int kMostBits = 30;
  const double longest = box_of(mesh.positions).longest;
  char text[200];
  if (!(precision.length >= 0) || precision.bits < 0 || precision.bits > kMostBits) {
    std::snprintf(text, sizeof text, "a precision of %g or %d bits: a length or 1 to %d bits",
                  precision.length, precision.bits, kMostBits);
    return fail(Error::CommandLine, text);
  }
  if (const double finest = finest_step(mesh); precision.length > 0 && precision.length < finest) {
    const double rounded_up = finest * 1.001;  // so that it may be asked for as it is written
    std::snprintf(
        text, sizeof text,
        "a precision of %g: the longest side is %g, and the finest grid of this model has "
        "steps of %.4g",
        precision.length, longest, rounded_up);
    return fail(Error::CommandLine, text);
  }
  if (!(longest > 0) || precision.length * kFewestSteps <= longest) return Done{};
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

namespace {

// The model's own grid, where that is coarser and has its numbers: in halves, quarters, ... until
// it is fine enough for where contracted vertices stand.
Grid grid_by_default(const Mesh& mesh, double longest) {
  constexpr int kLeastBits = 16;
  const double without = longest_without_strays(mesh);
  const double fine = std::ldexp(without, -Precision::kDefaultBits);
  std::optional<Grid> own = own_grid(mesh.positions, longest, fine);
  if (!own) return {{}, fine};
  const double enough = std::ldexp(without, -kLeastBits);
  while (own->step > enough && own->step / 2 >= finest_step(mesh)) own->step /= 2;
  return *own;
}

}  // namespace

Grid make_grid(const Mesh& mesh, const Precision& precision) {
  if (mesh.positions.empty()) return {};
  const auto [low, size, longest] = box_of(mesh.positions);
  Grid grid;
  if (precision.length > 0) {
    grid.step = precision.length;
  } else if (precision.bits > 0 || longest == 0) {
    grid.step = std::ldexp(longest, -precision.bits_or_default());
  } else {
    grid = grid_by_default(mesh, longest);
  }
  grid.step = std::max(grid.step, finest_step(mesh));
  if (!(grid.step > 0)) grid.step = 1;
  for (int i = 0; i < 3; ++i) {
    const double center = low[i] + 0.5 * size[i];
    const double steps = std::round((center - grid.origin[i]) / grid.step);
    grid.origin[i] += steps * grid.step;
  }
  return grid;
}

double snap(Mesh& mesh, const Grid& grid) {
  double farthest2 = 0;
  for (Vec3d& p : mesh.positions) {
    const Vec3d on_grid = grid.position(grid.nearest(p)), way = on_grid - p;
    farthest2 = std::max(farthest2, dot(way, way));
    p = on_grid;
  }
  return std::sqrt(farthest2);
}

}  // namespace crease
