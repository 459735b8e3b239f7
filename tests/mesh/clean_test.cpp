#include "mesh/clean.h"

#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {
namespace {

TEST_CASE("isolated vertices go, the others keep their order and their triangles") {
  Mesh mesh = hard_box(1);
  const std::vector<Vec3d> before = mesh.positions;
  mesh.positions.insert(mesh.positions.begin(), {9, 9, 9});
  mesh.positions.push_back({8, 8, 8});
  for (Triangle& t : mesh.triangles) {
    for (VertexId& v : t) v = VertexId{static_cast<std::uint32_t>(index_of(v)) + 1};
  }
  CHECK(drop_isolated_vertices(mesh) == 2);
  CHECK(mesh.positions == before);
  CHECK(mesh.triangles == hard_box(1).triangles);
  CHECK(drop_isolated_vertices(mesh) == 0);
}

TEST_CASE("a triangle with two equal corners is not proper; dropping it drops its corners") {
  Mesh mesh = hard_box(1);
  const std::size_t count = mesh.triangle_count();
  mesh.triangles[3][1] = mesh.triangles[3][0];
  const std::vector<AttributeId> normals = mesh.normals()->of_corner;
  const std::vector<bool> proper = proper_triangles(mesh);
  CHECK(std::count(proper.begin(), proper.end(), false) == 1);
  keep_triangles(mesh, proper);
  CHECK(mesh.triangle_count() == count - 1);
  CHECK(check_mesh(mesh).ok());
  CHECK(mesh.normals()->of_corner[3 * 3] == normals[3 * 4]);
}

TEST_CASE("repeated triangles are counted whichever way round they are") {
  Mesh mesh = hard_box(2);
  CHECK(count_duplicate_triangles(mesh) == 0);
  const auto [a, b, c] = mesh.triangles[5];
  mesh.triangles.push_back({b, c, a});
  mesh.triangles.push_back({c, b, a});
  CHECK(count_duplicate_triangles(mesh) == 2);
}

TEST_CASE("edges are counted where the two sides of a surface meet") {
  for (std::size_t turned = 0; turned < 12; ++turned) {
    Mesh mesh = hard_box(1);
    CHECK(count_misoriented_edges(mesh) == 0);
    std::swap(mesh.triangles[turned][1], mesh.triangles[turned][2]);
    CHECK(count_misoriented_edges(mesh) == 3);
    // A repeat, which is counted as such, and with it the edges have three triangles.
    mesh.triangles.push_back(mesh.triangles[turned]);
    CHECK(count_misoriented_edges(mesh) == 0);
  }
  Mesh twice = hard_box(1);
  twice.triangles = {twice.triangles[0], twice.triangles[0]};
  CHECK(count_misoriented_edges(twice) == 0);
}

TEST_CASE("triangles are counted whose normals all point against their winding") {
  Mesh mesh = hard_box(2);
  AttributeLayer normals = *mesh.normals();
  CHECK(count_reversed_normals(mesh, normals) == 0);
  std::swap(mesh.triangles[5][1], mesh.triangles[5][2]);
  std::swap(mesh.triangles[7][1], mesh.triangles[7][2]);
  CHECK(count_reversed_normals(mesh, normals) == 2);
  normals.of_corner[3 * 5 + 1] = kNoAttribute;
  CHECK(count_reversed_normals(mesh, normals) == 1);
}

TEST_CASE("points on a line span no area, at any offset") {
  CHECK(has_no_area({0, 0, 0}, {1, 1, 1}, {2, 2, 2}));
  CHECK(has_no_area({0, 0, 0}, {0, 0, 0}, {2, 2, 2}));
  // In decimals these lie on a line; in doubles the middle one is off by parts of the last place.
  CHECK(has_no_area({390000.1, 5820000.1, 0.1}, {390000.2, 5820000.2, 0.2},
                    {390000.3, 5820000.3, 0.3}));
  CHECK_FALSE(has_no_area({390000, 5820000, 0}, {390010, 5820000, 0}, {390005, 5820000.0001, 0}));
  CHECK_FALSE(has_no_area({0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0}));
}

TEST_CASE("welding a layer drops unused values and joins equal ones") {
  AttributeLayer layer{"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}};
  layer.values = {7, 7, 1, 2, 0.0f, 3, 1, 2, -0.0f, 3};
  for (std::uint32_t i : {1u, 2u, 3u, 4u, 3u, 1u}) layer.of_corner.push_back(AttributeId{i});
  weld_layer(layer);
  CHECK(layer.values == std::vector<float>{1, 2, 0, 3});
  const auto id = [](std::uint32_t i) { return AttributeId{i}; };
  CHECK(layer.of_corner == std::vector<AttributeId>{id(0), id(1), id(0), id(1), id(0), id(0)});
}

}  // namespace
}  // namespace crease
