#include "simplify/partition.h"

#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <vector>

using namespace crease;
using namespace crease::simplification;

namespace {

struct OnGrid {
  std::vector<Vec3i> positions;
  std::vector<std::uint32_t> corners, triangles;
};
OnGrid on_grid(const Mesh& mesh) {
  const Grid grid = make_grid(mesh, {});
  OnGrid made;
  for (const Vec3d& p : mesh.positions) made.positions.push_back(grid.nearest(p));
  for (const Triangle& t : mesh.triangles) {
    for (VertexId v : t) made.corners.push_back(static_cast<std::uint32_t>(v));
  }
  made.triangles.resize(mesh.triangle_count());
  std::iota(made.triangles.begin(), made.triangles.end(), 0u);
  return made;
}

// Vertices that several patches share.
std::size_t count_shared(const OnGrid& mesh, const Patches& patches) {
  constexpr std::uint32_t kNobody = 0xffffffffu;
  std::vector<std::uint32_t> owner(mesh.positions.size(), kNobody);
  std::vector<bool> is_shared(mesh.positions.size());
  for (std::uint32_t p = 0; p < patches.count(); ++p) {
    for (const std::uint32_t t : patches.of(p)) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = mesh.corners[3 * t + c];
        if (owner[v] != kNobody && owner[v] != p) is_shared[v] = true;
        owner[v] = p;
      }
    }
  }
  return static_cast<std::size_t>(std::count(is_shared.begin(), is_shared.end(), true));
}

}  // namespace

TEST_CASE("patches hold every triangle once, and none is too large") {
  const OnGrid mesh = on_grid(smooth_sphere(60, 60));
  for (int band = 0; band < 5; ++band) {
    const Patches patches =
        partition_triangles(mesh.positions, mesh.corners, mesh.triangles, 500, band);
    std::vector<std::uint32_t> seen = patches.triangles;
    std::sort(seen.begin(), seen.end());
    CHECK(seen == mesh.triangles);
    CHECK(patches.count() > 1);
    for (std::size_t p = 0; p < patches.count(); ++p) {
      CHECK(patches.of(p).size() <= 500);
      CHECK(!patches.of(p).empty());
      CHECK(std::is_sorted(patches.of(p).begin(), patches.of(p).end()));
    }
  }
}

TEST_CASE("rods in a layer below a tower are not sliced lengthwise") {
  // The tower makes z the longest axis, where half of the triangles are on either side of the
  // layer's middle: across it every rod would be shared by two patches from end to end.
  MeshBuilder b;
  for (int i = 0; i < 50; ++i) b.box({0, 0.2 * i, 0}, {12, 0.2 * i + 0.02, 0.02}, 10);
  b.box({4, 4, 0.1}, {6, 6, 14}, 10);
  const OnGrid mesh = on_grid(b.take());
  for (int band = 0; band < 5; ++band) {
    const Patches patches =
        partition_triangles(mesh.positions, mesh.corners, mesh.triangles, 16'000, band);
    CHECK(patches.count() > 1);
    CHECK(count_shared(mesh, patches) < mesh.positions.size() / 20);
  }
}

TEST_CASE("parts that a patch can hold are not cut") {
  // Long rods that lie side by side, of which no plane cuts few, and one that is too large.
  MeshBuilder b;
  for (int i = 0; i < 40; ++i) b.box({0.5 * (i % 3), 0.2 * i, 0}, {12, 0.2 * i + 0.1, 0.1}, 6);
  b.box({0, 0, 1}, {12, 8, 2}, 16);
  const OnGrid mesh = on_grid(b.take());
  const std::uint32_t most = 1000, rod_triangles = 6 * 6 * 6 * 2;
  std::vector<std::uint32_t> part_of_vertex(mesh.positions.size());
  std::iota(part_of_vertex.begin(), part_of_vertex.end(), 0u);
  const auto part_of = [&](std::uint32_t t) { return std::min(t / rod_triangles, 40u); };
  std::vector<std::uint32_t> name(41, kNone);
  for (const std::uint32_t t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh.corners[3 * t + c];
      std::uint32_t& of_part = name[part_of(t)];
      of_part = std::min(of_part, v);
      part_of_vertex[v] = of_part;
    }
  }
  for (std::uint32_t& v : part_of_vertex) v = part_of_vertex[v];
  for (int band = 0; band < 5; ++band) {
    const Patches patches = partition_triangles(mesh.positions, mesh.corners, mesh.triangles, most,
                                                band, part_of_vertex);
    std::vector<std::uint32_t> seen = patches.triangles;
    std::sort(seen.begin(), seen.end());
    CHECK(seen == mesh.triangles);
    std::vector<std::uint32_t> patch_of_part(40, kNone);
    for (std::uint32_t p = 0; p < patches.count(); ++p) {
      CHECK(patches.of(p).size() <= most);
      for (const std::uint32_t t : patches.of(p)) {
        if (part_of(t) == 40) continue;
        std::uint32_t& patch = patch_of_part[part_of(t)];
        if (patch == kNone) patch = p;
        CHECK(patch == p);
      }
    }
  }
}
