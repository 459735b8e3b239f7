#include "crease/compare.h"
#include "support/mesh_builder.h"

#include <doctest/doctest.h>

using namespace crease;

//  A unit square in z = 0, and points above it, beside it and on it.
TEST_CASE("distances to a square are those of elementary geometry") {
  MeshBuilder builder;
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, 2);
  const Mesh square = builder.take();
  const Vec3d points[] = {{0.4, 0.7, 2}, {4, 0.5, 4}, {-3, -4, 0}, {0.2, 0.9, 0}};
  for (int threads : {1, 2}) {
    const std::vector<float> distances = distances_to(square, points, threads);
    REQUIRE(distances.size() == 4);
    CHECK(distances[0] == doctest::Approx(2));
    CHECK(distances[1] == doctest::Approx(5));
    CHECK(distances[2] == doctest::Approx(5));
    CHECK(distances[3] == doctest::Approx(0));
  }
  CHECK(distances_to(square, {}).empty());
}
