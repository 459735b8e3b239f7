// A tree as games have it: branches of many triangles, amid leaves of two.
#include "simplify/reduce.h"
#include "support/mesh_builder.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

namespace crease {
namespace {

constexpr int kBranches = 12, kLeavesABranch = 16, kRings = 7, kSides = 3;

// Bent tubes, and squares with a corner near them, each turned another way.
Mesh tree() {
  MeshBuilder b;
  std::mt19937 random(5);
  const auto any = [&random](double low, double high) {
    return low + (high - low) * double(random()) / double(std::mt19937::max());
  };
  for (int k = 0; k < kBranches; ++k) {
    const double turn = 2.4 * k;
    const auto centre = [&](double t) {
      return Vec3d{4 * t * std::cos(turn + 0.4 * t), 4 * t * std::sin(turn + 0.4 * t),
                   0.8 * k + 1.2 * t * t};
    };
    VertexId ring[kRings][kSides];
    for (int r = 0; r < kRings; ++r) {
      const double t = 0.1 + 0.9 * r / (kRings - 1), radius = 0.05 * (1.2 - t);
      for (int i = 0; i < kSides; ++i) {
        const double angle = i * 2 * std::numbers::pi / kSides;
        ring[r][i] = b.vertex(centre(t) + Vec3d{-std::sin(turn) * std::cos(angle) * radius,
                                                std::cos(turn) * std::cos(angle) * radius,
                                                std::sin(angle) * radius});
      }
    }
    for (int r = 0; r + 1 < kRings; ++r) {
      for (int i = 0; i < kSides; ++i) {
        const int next = (i + 1) % kSides;
        b.flat_triangle({ring[r][i], ring[r][next], ring[r + 1][next]});
        b.flat_triangle({ring[r][i], ring[r + 1][next], ring[r + 1][i]});
      }
    }
    for (int l = 0; l < kLeavesABranch; ++l) {
      const Vec3d stem = centre(0.2 + 0.8 * l / kLeavesABranch) +
                         Vec3d{any(-0.1, 0.1), any(-0.1, 0.1), any(-0.1, 0.1)};
      const Vec3d along = normalized(Vec3d{any(-1, 1), any(-1, 1), any(-1, 1)});
      const Vec3d across = normalized(cross(along, Vec3d{any(-1, 1), any(-1, 1), any(-1, 1)}));
      const VertexId v[4] = {b.vertex(stem), b.vertex(stem + along * 0.7),
                             b.vertex(stem + (along + across) * 0.7),
                             b.vertex(stem + across * 0.7)};
      b.flat_triangle({v[0], v[1], v[2]});
      b.flat_triangle({v[0], v[2], v[3]});
    }
  }
  return b.take();
}

}  // namespace

// A leaf that is joined with a branch goes where the branch does, and both become plates in the
// air.
TEST_CASE("nothing of a tree is where the tree has nothing") {
  const Mesh mesh = tree();
  const std::size_t leaves = 2 * kBranches * kLeavesABranch;
  REQUIRE(mesh.triangle_count() == leaves + 2 * kBranches * kSides * (kRings - 1));
  const double of_all = reduce(mesh, leaves).apart.distance.b_to_a.mean;
  CHECK(of_all < 0.015);  // 0.023 where leaves join any branch
  const double of_some = reduce(mesh, leaves * 3 / 5).apart.distance.b_to_a.mean;
  CHECK(of_some < 0.025);  // 0.038
}

}  // namespace crease
