// What a small thing looks like does not depend on how large its surroundings are.
#include "hierarchy/triangle_sizes.h"
#include "simplify/reduce.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cstddef>

namespace crease {

TEST_CASE("few triangles far larger than the others count as large ones do") {
  TriangleSizes sizes;
  CHECK(sizes.mean() == 0);
  for (int i = 0; i < 98; ++i) sizes.add(1.5);
  CHECK(sizes.mean() == doctest::Approx(1.5));
  sizes.add(90);  // within 64 times what most are within: as it is
  CHECK(sizes.mean() == doctest::Approx((98 * 1.5 + 90) / 99));
  sizes.add(1e9);
  CHECK(sizes.most() == doctest::Approx(64 * 1.5));
  CHECK(sizes.mean() == doctest::Approx((98 * 1.5 + 90 + 96) / 100));

  TextureSize texture(96);
  const float corners[3][2] = {{0, 0}, {2, 0}, {0, 2}};  // 2
  texture.add(8, corners[0], corners[1], corners[2]);
  CHECK(texture.unit2() == doctest::Approx(4));
  texture.add(9600, corners[0], corners[1], corners[2]);  // a hundredth of it
  CHECK(texture.unit2() == doctest::Approx((8 + 96) / 2.02));
  CHECK(TextureSize(1).unit2() == 0);

  TextureSize palette(96);  // each triangle one texel of it, but for rounding
  for (const float u : {0.1f, 0.6f}) {
    const float texel[3][2] = {{u, u}, {u + 1e-6f, u}, {u, u + 1e-6f}};
    palette.add(8, texel[0], texel[1], texel[2]);
  }
  CHECK(palette.unit2() == 0);
}

namespace {

// A torus, and below it a square `times` as large.
Mesh torus_on_ground(double times) {
  Mesh mesh = torus(48, 48);
  const double half = 2.75 * times;
  AttributeLayer& normals = mesh.layers[0];
  const AttributeId up{static_cast<std::uint32_t>(normals.value_count())};
  normals.values.insert(normals.values.end(), {0, 0, 1});
  const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.positions.push_back({x * half, y * half, -1});
  }
  for (const std::uint32_t third : {2u, 3u}) {
    mesh.triangles.push_back(
        {VertexId{first}, VertexId{first + third - 1}, VertexId{first + third}});
    normals.of_corner.insert(normals.of_corner.end(), 3, up);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a model on a ground a thousand times its size is simplified as without it") {
  const Mesh alone = torus(48, 48);
  const std::size_t count = alone.triangle_count() / 10;
  const double least = reduce(alone, count).apart.distance.a_to_b.mean;
  for (const double times : {1.0, 30.0, 1000.0}) {
    CAPTURE(times);
    Reached level = reduce(torus_on_ground(times), count + 2);
    // Without the ground.
    Mesh& mesh = level.mesh;
    std::size_t kept = 0;
    AttributeLayer& normals = mesh.layers[0];
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      bool is_ground = true;
      for (const VertexId v : mesh.triangles[t]) {
        is_ground = is_ground && mesh.positions[index_of(v)].z < -0.9;
      }
      if (is_ground) continue;
      mesh.triangles[kept] = mesh.triangles[t];
      for (std::size_t c = 0; c < 3; ++c) {
        normals.of_corner[3 * kept + c] = normals.of_corner[3 * t + c];
      }
      ++kept;
    }
    mesh.triangles.resize(kept);
    normals.of_corner.resize(3 * kept);
    CHECK(kept >= count - 2);
    CompareOptions options;
    options.samples = 20'000;
    const double ratio = compare_meshes(alone, mesh, options)->distance.a_to_b.mean / least;
    CHECK(ratio < 1.15);  // RATIO
  }
}

}  // namespace crease
