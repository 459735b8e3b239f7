#include "mesh/guess_up.h"

#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace crease;

namespace {

Mesh with_y_and_z_swapped(Mesh mesh) {
  for (Vec3d& p : mesh.positions) std::swap(p.y, p.z);
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// A sheet over n x n cells with a hill, z up.
Mesh hill(int n) {
  Mesh mesh;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const double dx = x - n / 2.0, dy = y - n / 3.0;
      mesh.positions.push_back(
          {double(x), double(y), 0.3 * n * std::exp(-(dx * dx + dy * dy) / n)});
    }
  }
  const auto at = [n](int x, int y) { return VertexId{std::uint32_t(y * (n + 1) + x)}; };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("what stands on one side has the other up") {
  const Mesh standing = cone(24, 6);  // its tip up
  Mesh bare;
  bare.positions = standing.positions;
  bare.triangles = standing.triangles;
  for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) {
    CHECK(guess_up(bare, usual) == UpAxis::Z);
    CHECK(guess_up(with_y_and_z_swapped(bare), usual) == UpAxis::Y);
  }
}

TEST_CASE("a stray triangle says nothing of what is up") {
  for (const Vec3d& at : {Vec3d{1e5, 0, 0}, Vec3d{0, 1e5, 0}, Vec3d{0, 0, -1e5}}) {
    Mesh mesh;
    mesh.positions = cone(24, 6).positions;
    mesh.triangles = cone(24, 6).triangles;
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{0.1, 0, 0}, Vec3d{0, 0.1, 0}}) {
      mesh.positions.push_back(at + p);
    }
    mesh.triangles.push_back({VertexId{first}, VertexId{first + 1}, VertexId{first + 2}});
    for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) {
      CHECK(guess_up(mesh, usual) == UpAxis::Z);
      CHECK(guess_up(with_y_and_z_swapped(mesh), usual) == UpAxis::Y);
    }
  }
}

TEST_CASE("a field of heights has them up, and a drawing is seen from the front") {
  for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) {
    CHECK(guess_up(hill(12), usual) == UpAxis::Z);
    CHECK(guess_up(with_y_and_z_swapped(hill(12)), usual) == UpAxis::Y);
    Mesh flat = hill(12);
    for (Vec3d& p : flat.positions) p.z = 7;
    CHECK(guess_up(flat, usual) == UpAxis::Y);
    CHECK(guess_up(with_y_and_z_swapped(flat), usual) == UpAxis::Z);
  }
}

TEST_CASE("where nothing speaks for either it is as usual") {
  for (const UpAxis usual : {UpAxis::Y, UpAxis::Z}) {
    CHECK(guess_up(hard_box(4), usual) == usual);
    CHECK(guess_up(Mesh{}, usual) == usual);
    Mesh point;
    point.positions = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    point.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}}};
    const UpAxis any = guess_up(point, usual);
    CHECK((any == UpAxis::Y || any == UpAxis::Z));
  }
}
