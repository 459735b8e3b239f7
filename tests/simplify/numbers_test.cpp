// Numbers that vertices carry, temperatures, loads, ages, have a say in which triangles there are.
#include "simplify/reduce.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace crease;

namespace {

constexpr int kCells = 60;

// One value a vertex.
template <typename ValueAt>
void add_numbers(Mesh& mesh, const char* name, ValueAt value_at) {
  AttributeLayer& layer = mesh.layers.emplace_back();
  layer.name = name;
  layer.role = AttributeRole::Other;
  layer.interpolation = Interpolation::Linear;
  layer.dimension = 1;
  for (const Vec3d& p : mesh.positions) layer.values.push_back(float(value_at(p)));
  for (const Triangle& triangle : mesh.triangles) {
    for (VertexId v : triangle) layer.of_corner.push_back(AttributeId{std::uint32_t(v)});
  }
}

Mesh flat_sheet() {
  MeshBuilder builder;
  builder.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, kCells, kCells);
  return builder.take();
}

// What the last layer of a flat mesh has at a place.
double number_at(const Mesh& mesh, const Vec3d& p) {
  const AttributeLayer& layer = mesh.layers.back();
  double best = 1e300, number = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](std::size_t c) { return mesh.positions[index_of(mesh.triangles[t][c])]; };
    const double whole = cross(at(1) - at(0), at(2) - at(0)).z;
    if (whole == 0) continue;
    double outside = 0, sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d a = at((c + 1) % 3), b = at((c + 2) % 3);
      const double weight = cross(a - p, b - p).z / whole;
      outside = std::max(outside, -weight);
      sum += weight * double(layer.value(layer.of_corner[3 * t + c])[0]);
    }
    if (outside < best) {
      best = outside;
      number = sum;
    }
  }
  return number;
}

}  // namespace

TEST_CASE("a hot spot on a flat sheet and a step across it stay") {
  const auto temperature = [](const Vec3d& p) {
    const double away = std::hypot(p.x - 0.3, p.y - 0.7) * kCells / 2.5;
    return 300 + 200 * std::exp(-away * away / 2) + (p.x + p.y > 1.25 ? 50 : 0);
  };
  Mesh sheet = flat_sheet();
  add_numbers(sheet, "temperature", temperature);
  const Reached reached = reduce(sheet, sheet.triangle_count() / 8);
  CHECK(reached.apart.distance.a_to_b.max < 1e-6);
  double worst = 0;
  for (const Vec3d& p : sheet.positions) {
    worst = std::max(worst, std::abs(number_at(reached.mesh, p) - temperature(p)));
  }
  CHECK(worst < 5);  // of a range of 200
}

TEST_CASE("noise that vertices carry does not decide what triangles there are") {
  Mesh plain = smooth_sphere(40, 60), noisy = plain;
  std::mt19937 random(1);
  add_numbers(noisy, "confidence", [&](const Vec3d&) { return double(random()) / 4e9; });
  const std::size_t target = plain.triangle_count() / 10;
  const Reached without = reduce(plain, target), with = reduce(noisy, target);
  CHECK(with.apart.distance.a_to_b.mean < 1.1 * without.apart.distance.a_to_b.mean);
  CHECK(with.apart.normal_deviation.mean < 1.1 * without.apart.normal_deviation.mean);
}

TEST_CASE("a number that is always the same changes nothing") {
  Mesh plain = smooth_sphere(20, 30), same = plain;
  add_numbers(same, "age", [](const Vec3d&) { return 7.0; });
  const Reached without = reduce(plain, 200), with = reduce(same, 200);
  CHECK(with.mesh.positions == without.mesh.positions);
  CHECK(with.mesh.triangles == without.mesh.triangles);
}
