#include "simplify/partition.h"

#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

using namespace crease;
using namespace crease::simplification;

TEST_CASE("patches hold every triangle once, and none is too large") {
  const Mesh mesh = smooth_sphere(60, 60);
  const Grid grid = make_grid(mesh, {});
  std::vector<Vec3i> positions;
  for (const Vec3d& p : mesh.positions) positions.push_back(grid.nearest(p));
  std::vector<std::uint32_t> corners, all(mesh.triangle_count());
  for (const Triangle& t : mesh.triangles) {
    for (VertexId v : t) corners.push_back(static_cast<std::uint32_t>(v));
  }
  std::iota(all.begin(), all.end(), 0u);
  for (int band = 0; band < 5; ++band) {
    const Patches patches = partition_triangles(positions, corners, all, 500, band);
    std::vector<std::uint32_t> seen = patches.triangles;
    std::sort(seen.begin(), seen.end());
    CHECK(seen == all);
    CHECK(patches.count() > 1);
    for (std::size_t p = 0; p < patches.count(); ++p) {
      CHECK(patches.of(p).size() <= 500);
      CHECK(!patches.of(p).empty());
      CHECK(std::is_sorted(patches.of(p).begin(), patches.of(p).end()));
    }
  }
}
