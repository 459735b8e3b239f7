#include "mesh/weld_borders.h"

#include "mesh/clean.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace crease {
namespace {

// Every triangle with corners of its own, each off by `noise` at most in every coordinate.
Mesh torn(const Mesh& mesh, double noise) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-noise, noise);
  Mesh loose;
  for (const Triangle& t : mesh.triangles) {
    Triangle own;
    for (std::size_t c = 0; c < 3; ++c) {
      own[c] = VertexId{static_cast<std::uint32_t>(loose.vertex_count())};
      const Vec3d& p = mesh.positions[index_of(t[c])];
      loose.positions.push_back({p.x + off(random), p.y + off(random), p.z + off(random)});
    }
    loose.triangles.push_back(own);
  }
  return loose;
}

TEST_CASE("torn triangles are joined within a distance, and not beyond it") {
  const Mesh whole = smooth_sphere(20, 30);
  const double noise = 1e-6, apart = 2 * std::sqrt(3) * noise;
  Mesh mesh = torn(whole, noise);
  const std::vector<Vec3d> before = mesh.positions;
  CHECK(find_near_borders(mesh, noise / 100).count < mesh.vertex_count() / 100);
  const NearBorders near = find_near_borders(mesh, apart);
  CHECK(near.border_count == mesh.vertex_count());
  for (std::uint32_t v = 0; v < near.first.size(); ++v) {
    const std::uint32_t first = static_cast<std::uint32_t>(index_of(near.first[v]));
    CHECK(first <= v);
    CHECK(near.first[first] == near.first[v]);
    CHECK(length(before[first] - before[v]) <= apart);
  }
  CHECK(weld_borders(mesh, near) == near.count);
  CHECK(mesh.vertex_count() == whole.vertex_count());
  CHECK(mesh.triangle_count() == whole.triangle_count());
  CHECK(find_near_borders(mesh, apart).border_count == 0);
}

TEST_CASE("what is closed stays, however near it is") {
  MeshBuilder builder;
  builder.box({0, 0, 0}, {1, 1, 1}, 2);
  builder.box({1 + 1e-9, 0, 0}, {2, 1, 1}, 2);
  const Mesh boxes = builder.take();
  const NearBorders near = find_near_borders(boxes, 1e-6);
  CHECK(near.border_count == 0);
  CHECK(near.count == 0);
}

TEST_CASE("no triangle loses a corner") {
  Mesh mesh;
  for (int i = 0; i < 6; ++i) mesh.positions.push_back({i * 1e-4, (i % 2) * 1.0, 0});
  mesh.positions.push_back({5, 5, 0});
  const auto v = [](std::uint32_t i) { return VertexId{i}; };
  mesh.triangles = {{v(0), v(1), v(2)}, {v(2), v(1), v(6)}, {v(3), v(4), v(6)}};
  weld_borders(mesh, find_near_borders(mesh, 1e-3));
  for (const Triangle& t : mesh.triangles) {
    CHECK(t[0] != t[1]);
    CHECK(t[1] != t[2]);
    CHECK(t[2] != t[0]);
  }
}

// A sphere as sines and cosines give it, with a column of vertices for each end of u and a row of
// them at each pole: 2 * pi and pi are no zeros of a sine in doubles, nor in floats.
Mesh sphere_of_sines(std::uint32_t around, std::uint32_t down, bool floats) {
  Mesh mesh;
  const auto rounded = [&](double x) { return floats ? double(float(x)) : x; };
  for (std::uint32_t j = 0; j <= down; ++j) {
    for (std::uint32_t i = 0; i <= around; ++i) {
      const double u = rounded(2 * std::numbers::pi * i / around);
      const double v = rounded(std::numbers::pi * j / down);
      mesh.positions.push_back({rounded(std::cos(u) * std::sin(v)), rounded(std::cos(v)),
                                rounded(std::sin(u) * std::sin(v))});
    }
  }
  for (std::uint32_t j = 0; j < down; ++j) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = j * (around + 1) + i, below = a + around + 1;
      mesh.triangles.push_back({VertexId{a}, VertexId{below}, VertexId{below + 1}});
      mesh.triangles.push_back({VertexId{a}, VertexId{below + 1}, VertexId{a + 1}});
    }
  }
  return mesh;
}

TEST_CASE("the seam and the poles of a sphere close where sines have not") {
  for (const bool floats : {false, true}) {
    CAPTURE(floats);
    Mesh mesh = sphere_of_sines(32, 16, floats);
    weld_borders(mesh, find_near_borders(mesh, rounding_of(mesh)));
    keep_triangles(mesh, proper_triangles(mesh));
    CHECK(mesh.vertex_count() == 32 * 15 + 2);
    CHECK(mesh.triangle_count() == 32 * 15 * 2);
    CHECK(find_near_borders(mesh, 0).border_count == 0);
  }
}

TEST_CASE("no border closes because of a triangle that is far away") {
  Mesh mesh = height_field(16);
  const std::size_t count = mesh.vertex_count(), border = find_near_borders(mesh, 0).border_count;
  REQUIRE(border == 64);
  for (const Vec3d& p : {Vec3d{1e6, 0, 0}, Vec3d{1e6, 1, 0}, Vec3d{1e6, 0, 1}}) {
    mesh.positions.push_back(p);
  }
  const auto far = static_cast<std::uint32_t>(count);
  mesh.triangles.push_back({VertexId{far}, VertexId{far + 1}, VertexId{far + 2}});
  CHECK(rounding_of(mesh) < 0.001);
  CHECK(find_near_borders(mesh, rounding_of(mesh)).count == 0);
}

TEST_CASE("what is all rounding stays as it is") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1e-12, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}}};
  CHECK(weld_borders(mesh, find_near_borders(mesh, rounding_of(mesh))) == 0);
  CHECK(mesh.vertex_count() == 3);
}

}  // namespace
}  // namespace crease
