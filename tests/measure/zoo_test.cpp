// The zoo itself: what every other test takes for granted about it.
#include "crease/shading.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace crease;

namespace {

// The least cosine between a corner's normal and its triangle's.
double least_agreement(const Mesh& mesh) {
  double least = 1;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3d a = mesh.positions[index_of(mesh.triangles[t][0])];
    const Vec3d geometric = cross(mesh.positions[index_of(mesh.triangles[t][1])] - a,
                                  mesh.positions[index_of(mesh.triangles[t][2])] - a);
    if (length(geometric) < 1e-12) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + c]);
      least = std::min(least, dot(normalized(geometric), Vec3d{n[0], n[1], n[2]}));
    }
  }
  return least;
}

std::ptrdiff_t count(const Mesh& mesh, TriangleKind kind) {
  return std::ranges::count(classify_shading(mesh).of_triangle, kind);
}

}  // namespace

TEST_CASE("every mesh of the zoo keeps the promises of mesh.h and has normals that fit") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    CHECK(check_mesh(z.mesh).ok());
    REQUIRE(z.mesh.normals() != nullptr);
    CHECK(&z.mesh.layers[0] == z.mesh.normals());
    CHECK(z.mesh.triangle_count() < 2000);
    CHECK(least_agreement(z.mesh) > 0.5);
  }
}

TEST_CASE("builders shade as their names say") {
  CHECK(count(smooth_sphere(8, 12), TriangleKind::SN) == 2 * 12 * 7);
  CHECK(count(faceted_sphere(8, 12), TriangleKind::FN) == 2 * 12 * 7);
  CHECK(count(bevelled_box(), TriangleKind::SN) == 44);
  CHECK(count(gear(40), TriangleKind::FN) == 640);
  CHECK(count(noisy_box(2, 0.5), TriangleKind::NSN) == 48);
  // Of 5 x 5 quads a side, the 3 x 3 that touch no edge are SN.
  CHECK(count(hard_box(5), TriangleKind::SN) == 6 * 9 * 2);
  CHECK(count(hard_box(5), TriangleKind::FN) == 6 * 16 * 2);
}

TEST_CASE("noise tilts by no more than was asked for") {
  const double least = least_agreement(noisy_box(8, 0.5));
  CHECK(least >= std::cos(radians(0.5001)));
  CHECK(least < std::cos(radians(0.3)));
}
