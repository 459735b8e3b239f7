#include "crease/contraction.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {
namespace {

//   0---1---2    Left of the hard edge 1-4 everything has normal `left`, right of it `right`.
//   | / | / |
//   3---4---5
struct Strips {
  AttributeId left, right;
  Mesh mesh;
};

Strips two_strips() {
  MeshBuilder b;
  Strips s;
  s.left = b.normal({0, 0, 1});
  s.right = b.normal({1, 0, 1});
  for (double y : {1.0, 0.0}) {
    for (double x : {0.0, 1.0, 2.0}) b.vertex({x, y, 0});
  }
  const auto v = [](std::uint32_t i) { return VertexId{i}; };
  b.triangle({v(0), v(3), v(1)}, s.left);
  b.triangle({v(3), v(4), v(1)}, s.left);
  b.triangle({v(1), v(4), v(2)}, s.right);
  b.triangle({v(4), v(5), v(2)}, s.right);
  s.mesh = b.take();
  return s;
}

ContractionSequence one_contraction(std::uint32_t p, std::uint32_t q, Vec3i position) {
  ContractionSequence sequence;
  sequence.grid.step = 0.5;
  Contraction c;
  c.removed = VertexId{p};
  c.kept = VertexId{q};
  c.position = position;
  sequence.contractions.push_back(c);
  return sequence;
}

TEST_CASE("contracting along the hard edge drops its two triangles and keeps both normals") {
  const Strips strips = two_strips();
  const ContractionSequence sequence = one_contraction(1, 4, {2, 1, 0});
  CHECK(check_contractions(strips.mesh, sequence).ok());
  const Level level = apply_contractions(strips.mesh, sequence, 1);
  CHECK(level.alive == std::vector<bool>{true, false, false, true});
  CHECK(level.triangles[0] == Triangle{VertexId{0}, VertexId{3}, VertexId{4}});
  CHECK(level.of_corner[0][2] == strips.left);
  CHECK(level.of_corner[0][9] == strips.right);

  const Mesh mesh = mesh_of_level(strips.mesh, sequence, level);
  CHECK(mesh.triangle_count() == 2);
  CHECK(mesh.vertex_count() == 5);
  CHECK(mesh.positions[2] == Vec3d{1, 0.5, 0});  // 4, third in order of use
  CHECK(mesh.layers[0].value_count() == 2);
}

TEST_CASE("an attribute change reaches every corner at the kept vertex and no other") {
  const Strips strips = two_strips();
  ContractionSequence sequence = one_contraction(1, 4, {2, 1, 0});
  sequence.new_values = {{0, 1, 0}};
  const AttributeId fresh{static_cast<std::uint32_t>(strips.mesh.layers[0].value_count())};
  sequence.changes = {{0, strips.left, fresh}};
  sequence.contractions[0].change_count = 1;
  CHECK(check_contractions(strips.mesh, sequence).ok());
  const Level level = apply_contractions(strips.mesh, sequence, 1);
  CHECK(level.of_corner[0][0] == strips.left);
  CHECK(level.of_corner[0][1] == strips.left);
  CHECK(level.of_corner[0][2] == fresh);
  CHECK(level.of_corner[0][9] == strips.right);
  const Mesh mesh = mesh_of_level(strips.mesh, sequence, level);
  const auto value = mesh.layers[0].value(mesh.layers[0].of_corner[2]);
  CHECK(std::vector<float>(value.begin(), value.end()) == std::vector<float>{0, 1, 0});
}

TEST_CASE("a derived triangle shows the normal of its corners, and its stored one without area") {
  const Strips strips = two_strips();
  ContractionSequence sequence = one_contraction(1, 4, {2, 1, 2});
  sequence.derived = {TriangleId{0}};
  sequence.contractions[0].derived_count = 1;
  CHECK(check_contractions(strips.mesh, sequence).ok());
  const auto normal_of_first = [&] {
    const Mesh mesh =
        mesh_of_level(strips.mesh, sequence, apply_contractions(strips.mesh, sequence, 1));
    const auto value = mesh.layers[0].value(mesh.layers[0].of_corner[0]);
    return Vec3f{value[0], value[1], value[2]};
  };
  const Vec3d expected = normalized(cross(Vec3d{0, -2, 0}, Vec3d{2, -1, 2}));
  CHECK(length(normal_of_first() - Vec3f{float(expected.x), float(expected.y), float(expected.z)}) <
        1e-6f);
  sequence.contractions[0].position = {0, 1, 0};  // on the line through 0 and 3
  CHECK(normal_of_first() == Vec3f{0, 0, 1});
}

TEST_CASE("level 0 is the snapped mesh and the last level has no triangles") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    Mesh mesh = z.mesh;
    const Grid grid = make_grid(mesh, {.bits = 16});
    snap(mesh, grid);
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      const ContractionSequence s =
          random_contractions(mesh, grid, {.seed = 3, .placement = placement});
      const Status status = check_contractions(mesh, s);
      CHECK_MESSAGE(status.ok(), (status.ok() ? "" : status.failure().message));
      CHECK(s.contractions.size() + 1 >= mesh.vertex_count());

      const Level finest = apply_contractions(mesh, s, 0);
      CHECK(finest.triangles == mesh.triangles);
      CHECK(std::ranges::count(finest.alive, false) == 0);
      const Mesh again = mesh_of_level(mesh, s, finest);
      CHECK(again.triangle_count() == mesh.triangle_count());
      CHECK(check_mesh(again).ok());
      const Level coarsest = apply_contractions(mesh, s, s.contractions.size());
      CHECK(std::ranges::count(coarsest.alive, true) == 0);
    }
  }
}

}  // namespace
}  // namespace crease
