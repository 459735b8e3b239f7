// The grid of positions: how fine it can be, and what makes it coarse.
#include "crease/mesh.h"

#include "mesh/own_grid.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

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
    CHECK_FALSE(check_precision(mesh, {.bits = 31}).ok());
    CHECK_FALSE(check_precision(mesh, {.bits = -1}).ok());
    CHECK_FALSE(check_precision(mesh, {.length = -finest}).ok());
    CHECK_FALSE(check_precision(mesh, {.length = std::nan("")}).ok());
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
    // By default the others have the steps that they would have without.
    CHECK(make_grid(far, {}).step <= 1.01 * std::max(make_grid(sphere, {}).step, finest_step(far)));

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

TEST_CASE("strays that are far and strays that are a thousand times as far are found") {
  Mesh mesh = smooth_sphere(60, 120);
  add_triangle(mesh, {1e3, 0, 0});
  add_triangle(mesh, {0, -1e6, 0});
  const std::optional<Strays> strays = find_strays(mesh);
  REQUIRE(strays.has_value());
  CHECK(strays->count == 6);
  CHECK(strays->longest == doctest::Approx(1e6).epsilon(0.01));
  CHECK(strays->longest_without == doctest::Approx(2).epsilon(0.01));
}

std::vector<Vec3d> random_points(std::size_t count, double size, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> along(0, size);
  std::vector<Vec3d> points(count);
  for (Vec3d& p : points) p = {along(random), along(random), along(random)};
  return points;
}

// As if they had been written on a grid, read again and moved.
std::vector<Vec3d> on_grid(std::vector<Vec3d> points, double step_of, double divisor, double away) {
  for (Vec3d& p : points) {
    for (double* x : {&p.x, &p.y, &p.z}) {
      *x = (std::round(*x / step_of * divisor) + std::round(away / step_of * divisor)) * step_of /
           divisor;
    }
  }
  return points;
}

std::vector<Vec3d> as_floats(std::vector<Vec3d> points) {
  for (Vec3d& p : points) p = {float(p.x), float(p.y), float(p.z)};
  return points;
}

double own_step(const std::vector<Vec3d>& points, double longest) {
  const auto grid = own_grid(points, longest, std::ldexp(longest, -24));
  return grid ? grid->step : 0;
}

TEST_CASE("numbers of so many decimals, or sixteenths, are on a grid of these") {
  const std::vector<Vec3d> some = random_points(400, 100, 1);
  for (const double away : {0.0, 7e3, -1.2e6}) {
    CHECK(own_step(on_grid(some, 1, 1000, away), 100) == 0.001);
    CHECK(own_step(on_grid(some, 1, 100'000, away), 100) == 0.00001);
    CHECK(own_step(on_grid(some, 5, 1000, away), 100) == 0.005);
    CHECK(own_step(on_grid(some, 1, 16, away), 100) == 0.0625);
    CHECK(own_step(on_grid(some, 10, 1, away), 100) == 10);
  }
  CHECK(own_step(as_floats(on_grid(some, 1, 1000, 0)), 100) == 0.001);
  CHECK(own_step(as_floats(on_grid(some, 2, 10'000, 0)), 100) == 0.0002);
  // Finer than what is used by default.
  CHECK(own_step(on_grid(some, 1, 10'000'000, 0), 100) == 0);
}

TEST_CASE("numbers that are whole steps apart are on a grid, wherever it lies") {
  const std::vector<Vec3d> some = random_points(2000, 1, 2);
  for (const double step : {1.0 / 16383, 0.0123456 / 255, 1.7 / 65535}) {
    std::vector<Vec3d> quantized = some;
    for (Vec3d& p : quantized) {
      p = {std::round(p.x / step) * step - 0.387, std::round(p.y / step) * step + 0.1234,
           std::round(p.z / step) * step + 0.777};
    }
    for (const auto& points : {quantized, as_floats(quantized)}) {
      const auto grid = own_grid(points, 1, 0x1p-24);
      REQUIRE(grid.has_value());
      CHECK(grid->step == doctest::Approx(step).epsilon(1e-5));
      double most = 0;
      for (const Vec3d& p : points) {
        const Vec3d off = grid->position(grid->nearest(p)) - p;
        most = std::max({most, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
      }
      CHECK(most < 0x1p-22);
    }
  }
}

TEST_CASE("numbers of no grid have none, nor such of which one is off") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<Vec3d> some = random_points(100, 1, seed);
    CHECK(own_step(some, 1) == 0);
    CHECK(own_step(as_floats(some), 1) == 0);
    std::vector<Vec3d> nearly = on_grid(some, 1, 1000, 0);
    nearly[seed].y += 0.1 / 3001;
    CHECK(own_step(nearly, 1) == 0);
  }
  CHECK(own_step({}, 1) == 0);
}

TEST_CASE("by default a grid is the model's own, fine enough, and no finer than others") {
  Mesh mesh = smooth_sphere(20, 40);
  CHECK(make_grid(mesh, {}).step == make_grid(mesh, {.bits = 24}).step);
  CHECK(make_grid(mesh, {}).step == std::ldexp(2.0, -24));
  mesh.positions = on_grid(mesh.positions, 1, 1'000'000, 3);
  const std::vector<Vec3d> before = mesh.positions;
  const Grid grid = make_grid(mesh, {});
  CHECK(grid.step == 0.000001);
  const double farthest = snap(mesh, grid);
  double most = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    most = std::max(most, length(mesh.positions[v] - before[v]));
  }
  CHECK(most <= 4 * 0x1p-51);
  CHECK(farthest == most);
  // So few steps that contracted vertices would have nowhere to go.
  mesh.positions = on_grid(mesh.positions, 1, 100, 0);
  CHECK(make_grid(mesh, {}).step == 0.01 / 512);
  CHECK(make_grid(hard_box(2), {}).step == 0x1p-16);
  // Where all is one point.
  for (Vec3d& p : mesh.positions) p = {1, 1, 1};
  CHECK(make_grid(mesh, {}).step > 0);
}

}  // namespace
}  // namespace crease
