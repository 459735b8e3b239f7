#include "crease/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace crease {

Vec3i Grid::nearest(const Vec3d& p) const {
  return {static_cast<std::int32_t>(std::llround((p.x - origin.x) / step)),
          static_cast<std::int32_t>(std::llround((p.y - origin.y) / step)),
          static_cast<std::int32_t>(std::llround((p.z - origin.z) / step))};
}

namespace {

constexpr int kFewestBits = 12, kMostBits = 24;
constexpr double kStepsOfShortEdge = 256;

// The length that nine of ten edges exceed, of those that have one; 0 if none has.
double short_edge(const Mesh& mesh) {
  std::vector<double> squared;
  squared.reserve(3 * mesh.triangle_count());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d edge = mesh.positions[index_of(t[(c + 1) % 3])] - mesh.positions[index_of(t[c])];
      const double length2 = dot(edge, edge);
      if (length2 > 0) squared.push_back(length2);
    }
  }
  if (squared.empty()) return 0;
  const auto tenth = squared.begin() + std::ptrdiff_t(squared.size() / 10);
  std::nth_element(squared.begin(), tenth, squared.end());
  return std::sqrt(*tenth);
}

int bits_for(const Mesh& mesh, double longest) {
  const double step = short_edge(mesh) / kStepsOfShortEdge;
  int bits = kFewestBits;
  while (bits < kMostBits && longest > step * double(1 << bits)) ++bits;
  return bits;
}

}  // namespace

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
  grid.step = precision.length;
  if (!(precision.length > 0)) {
    const int bits = precision.bits > 0 ? precision.bits : bits_for(mesh, longest);
    grid.step = longest / double(1 << bits);
  }
  // Grid coordinates stay within 30 bits whatever length was asked for.
  grid.step = std::max(grid.step, longest / double(1 << 30));
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
