// The grid of positions: how fine it can be, and what makes it coarse.
#include "crease/mesh.h"

#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

namespace crease {
namespace {

Mesh moved(Mesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.positions) p = p + by;
  return mesh;
}

void add_triangle(Mesh& mesh, const Vec3d& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
  for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{0.1, 0, 0}, Vec3d{0, 0.1, 0}}) {
    mesh.positions.push_back(at + p);
  }
  mesh.triangles.push_back({VertexId{first}, VertexId{first + 1}, VertexId{first + 2}});
}

TEST_CASE("a length shorter than the finest step is refused, with one that is not") {
  for (const Vec3d& away : {Vec3d{}, Vec3d{1e6, 2e9, 0}}) {
    const Mesh mesh = moved(hard_box(2), away);
    const double finest = finest_step(mesh);
    CHECK(finest == std::max(std::ldexp(1.0, -30), std::ldexp(away.y + (away.y > 0), -49)));
    CHECK(check_precision(mesh, {.length = finest}).ok());
    CHECK(check_precision(mesh, {.bits = 30}).ok());
    const Status refused = check_precision(mesh, {.length = 0.99 * finest});
    REQUIRE(!refused.ok());
    CHECK(refused.failure().error == Error::CommandLine);
    const std::string& words = refused.failure().message;
    const double named = std::stod(words.substr(words.rfind(' ')));
    CHECK(named >= finest);
    CHECK(named < 1.01 * finest);
    CHECK(make_grid(mesh, {.length = named}).step == named);
  }
}

TEST_CASE("of every mesh of the zoo no vertex is a stray") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    CHECK(!find_strays(z.mesh).has_value());
  }
}

TEST_CASE("a triangle far away from all others is found, one that is near or of many is not") {
  const Mesh sphere = smooth_sphere(20, 40);
  for (const Vec3d& direction : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0.5, 1, -1}}) {
    Mesh far = moved(sphere, {1e4, 0, 0});
    add_triangle(far, Vec3d{1e4, 0, 0} + direction * 1000);
    const std::optional<Strays> strays = find_strays(far);
    REQUIRE(strays.has_value());
    CHECK(strays->count == 3);
    CHECK(strays->longest == doctest::Approx(1001).epsilon(0.001));
    CHECK(strays->longest_without == doctest::Approx(2).epsilon(0.01));

    Mesh near = sphere;
    add_triangle(near, direction * 28);
    CHECK(!find_strays(near).has_value());
    Mesh many = sphere;
    for (int i = 0; i < 2; ++i) add_triangle(many, direction * 1000);
    CHECK(!find_strays(many).has_value());  // of 782 vertices six
  }
}

TEST_CASE("strays on several sides are found, and those of a large mesh may be more") {
  Mesh mesh = smooth_sphere(60, 120);
  add_triangle(mesh, {900, 0, 0});
  add_triangle(mesh, {-900, 10, 40});
  const std::optional<Strays> strays = find_strays(mesh);
  REQUIRE(strays.has_value());
  CHECK(strays->count == 6);
  CHECK(strays->longest_without == doctest::Approx(2).epsilon(0.01));
}

}  // namespace
}  // namespace crease
