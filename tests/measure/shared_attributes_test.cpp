#include "measure/shared_attributes.h"
#include "crease/compare.h"
#include "measure/closest_point.h"
#include "measure/mesh_pairs.h"
#include "measure/sample.h"
#include "measure/surface.h"
#include "support/mesh_builder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>
#include <vector>

using namespace crease;

namespace {

// A unit square of cells * cells * 2 triangles.
Mesh square(int cells) {
  MeshBuilder b;
  b.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells, cells);
  return b.take();
}

AttributeLayer layer(const char* name, AttributeRole role = AttributeRole::Other,
                     Interpolation interpolation = Interpolation::Linear) {
  AttributeLayer made;
  made.name = name;
  made.role = role;
  made.interpolation = interpolation;
  return made;
}

using ValueAt = std::function<std::vector<float>(const Vec3d&)>;
// Of a value for each corner, by its place.
void add_layer(Mesh& mesh, AttributeLayer layer, const ValueAt& value) {
  for (std::size_t c = 0; c < 3 * mesh.triangle_count(); ++c) {
    const std::vector<float> numbers =
        value(mesh.positions[index_of(mesh.triangles[c / 3][c % 3])]);
    layer.dimension = static_cast<std::uint32_t>(numbers.size());
    layer.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(c)});
    layer.values.insert(layer.values.end(), numbers.begin(), numbers.end());
  }
  mesh.layers.push_back(std::move(layer));
}

Mesh colored(int cells, const ValueAt& value, const char* name = "color") {
  Mesh mesh = square(cells);
  add_layer(mesh, layer(name, AttributeRole::Color), value);
  return mesh;
}

const AttributeDeviation& only_one(const Comparison& c) {
  REQUIRE(c.attributes.size() == 1);
  return c.attributes[0];
}

}  // namespace

TEST_CASE("what is blended over the triangles differs by its values") {
  const ValueAt ramp = [](const Vec3d& p) { return std::vector<float>{float(p[0]), 0.5f, 0}; };
  const ValueAt shifted = [](const Vec3d& p) {
    return std::vector<float>{float(p[0]) + 0.3f, 0.9f, 0, 1};  // and an alpha
  };
  const Mesh a = colored(1, ramp);
  const Comparison same = *compare_meshes(a, colored(7, ramp, "COLOR_0"), {.samples = 1000});
  CHECK(only_one(same).name == "color");
  CHECK(only_one(same).unit == DeviationUnit::Values);
  CHECK(only_one(same).spread.max < 1e-6);
  const Comparison off = *compare_meshes(a, colored(7, shifted), {.samples = 1000});
  for (const double d :
       {only_one(off).spread.mean, only_one(off).spread.p95, only_one(off).spread.max}) {
    CHECK(d == doctest::Approx(0.5));
  }
}

TEST_CASE("a sample on a seam sees the side that agrees") {
  const auto with_seam = [](int cells) {
    Mesh mesh = square(cells);
    AttributeLayer uv = layer("uv", AttributeRole::TexCoord);
    uv.dimension = 2;
    for (std::size_t c = 0; c < 3 * mesh.triangle_count(); ++c) {
      double middle = 0;
      for (const VertexId v : mesh.triangles[c / 3]) middle += mesh.positions[index_of(v)][0] / 3;
      const Vec3d& p = mesh.positions[index_of(mesh.triangles[c / 3][c % 3])];
      uv.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(c)});
      uv.values.insert(uv.values.end(), {float(p[0]) + (middle > 0.5 ? 5.0f : 0.0f), float(p[1])});
    }
    mesh.layers.push_back(uv);
    return mesh;
  };
  const Comparison c = *compare_meshes(with_seam(2), with_seam(6), {.samples = 20'000});
  CHECK(only_one(c).spread.max < 1e-5);
}

TEST_CASE("directions differ by degrees, categories by the share of the surface") {
  Mesh a = square(1), b = square(4);
  const auto along = [](double angle) {
    const std::vector<float> direction{float(std::cos(angle)), float(std::sin(angle)), 0};
    return [direction](const Vec3d&) { return direction; };
  };
  const AttributeLayer tangent = layer("tangent", AttributeRole::Other, Interpolation::Direction);
  add_layer(a, tangent, along(0.1));
  add_layer(b, tangent, along(0.1 + radians(25.0)));
  const AttributeLayer label = layer("label", AttributeRole::Other, Interpolation::Categorical);
  add_layer(a, label, [](const Vec3d&) { return std::vector<float>{3}; });
  add_layer(b, label, [](const Vec3d& p) { return std::vector<float>{p[0] < 0.4 ? 3.0f : 4.0f}; });
  add_layer(a, layer("mine"), [](const Vec3d&) { return std::vector<float>{0}; });
  add_layer(b, layer("yours"), [](const Vec3d&) { return std::vector<float>{0}; });
  const Comparison c = *compare_meshes(a, b, {.samples = 20'000});
  REQUIRE(c.attributes.size() == 2);
  CHECK(c.attributes[0].name == "tangent");
  CHECK(c.attributes[0].unit == DeviationUnit::Degrees);
  CHECK(c.attributes[0].spread.mean == doctest::Approx(25).epsilon(1e-4));
  CHECK(c.attributes[1].unit == DeviationUnit::Share);
  // Corners at 0.25 have 3, at 0.5 4: the border is half way between them.
  CHECK(c.attributes[1].spread.mean == doctest::Approx(0.625).epsilon(0.03));
}

TEST_CASE("materials and parts are told by their names") {
  Mesh a = square(2), b = square(2);
  a.materials = {{.name = "brick"}, {.name = "glass"}, {.base_color = {1, 0, 0, 1}}};
  b.materials = {{.base_color = {1, 0, 0, 1}}, {.name = "glass"}, {.name = "brick"}};
  for (std::uint32_t t = 0; t < 8; ++t) {
    a.material_of_triangle.push_back(MaterialId{t % 3});
    b.material_of_triangle.push_back(MaterialId{2 - t % 3});
  }
  CHECK(only_one(*compare_meshes(a, b, {.samples = 1000})).name == "material");
  CHECK(only_one(*compare_meshes(a, b, {.samples = 1000})).spread.max == 0);
  b.material_of_triangle[0] = b.material_of_triangle[1];
  CHECK(only_one(*compare_meshes(a, b, {.samples = 8000})).spread.mean ==
        doctest::Approx(1 / 8.0).epsilon(0.02));
  a.parts = b.parts = {"one", "two"};
  a.part_of_triangle.assign(8, PartId{0});
  b.part_of_triangle.assign(8, PartId{1});
  const Comparison c = *compare_meshes(a, b, {.samples = 1000});
  REQUIRE(c.attributes.size() == 2);
  CHECK(c.attributes[1].name == "part");
  CHECK(c.attributes[1].spread.mean == 1);
}

TEST_CASE("a material without a name is the one that got a name and looks the same") {
  Mesh a = square(4), b = a;
  a.materials = {{.base_color = {1, 0, 0, 1}}, {.name = "glass"}, {.base_color = {0, 1, 0, 1}}};
  b.materials = {{.name = "material 2", .base_color = {0, 0.999f, 0, 1}},
                 {.name = "default", .base_color = {1, 0, 0, 1}},
                 {.name = "glass"}};
  for (std::uint32_t t = 0; t < a.triangle_count(); ++t) {
    a.material_of_triangle.push_back(MaterialId{t % 3});
    b.material_of_triangle.push_back(MaterialId{(t + 1) % 3});
  }
  CHECK(only_one(*compare_meshes(a, b, {.samples = 1000})).spread.max == 0);
  CHECK(only_one(*compare_meshes(b, a, {.samples = 1000})).spread.max == 0);
  b.materials[1].base_color = {0, 0, 1, 1};
  CHECK(only_one(*compare_meshes(a, b, {.samples = 1000})).spread.max == 1);
}

TEST_CASE("deviations equal the brute force, zoo mesh against zoo mesh") {
  const ValueAt waves = [](const Vec3d& p) {
    return std::vector<float>{float(std::sin(5 * p[0]) + p[2]), float(std::cos(3 * p[1]))};
  };
  for_zoo_pairs([&](const Mesh& first, const Mesh& second) {
    Mesh a = first, b = second;
    for (Mesh* mesh : {&a, &b}) {
      std::erase_if(mesh->layers,
                    [](const AttributeLayer& l) { return l.role != AttributeRole::Normal; });
      mesh->material_of_triangle = {};
      mesh->part_of_triangle = {};
      mesh->parts = {};
      add_layer(*mesh, layer("waves"), waves);
    }
    const Frame frame = common_frame(a, b);
    const Surface from(a, frame), to(b, frame);
    const SharedAttributes shared(a, b);
    REQUIRE(shared.count() == 1);
    const double tie = 1e-5 * frame.diagonal * frame.scale;
    const Sampler sampler(from, 50, 3);
    Surface::Scratch scratch;
    const auto value = [](const Mesh& mesh, std::size_t t, const std::array<double, 3>& weights) {
      std::array<double, 2> sum{};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 2; ++k) {
          sum[k] += weights[c] * double(mesh.layers.back().values[2 * (3 * t + c) + k]);
        }
      }
      return sum;
    };
    for (std::size_t i = 0; i < 50; ++i) {
      const SurfacePoint s = sampler(i);
      Vec3d p;
      for (std::size_t c = 0; c < 3; ++c) p += from.corner(s.triangle, c) * s.weights[c];
      const Nearest nearest = to.nearest(p, nullptr, tie, scratch);
      const double got = shared.deviation(0, s, scratch.candidates, 0);
      const std::array<double, 2> own = value(a, s.triangle, s.weights);
      double expected = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < b.triangle_count(); ++t) {
        const ClosestPoint there =
            closest_point(p, to.corner(t, 0), to.corner(t, 1), to.corner(t, 2));
        if (std::sqrt(there.squared_distance) > nearest.distance + tie) continue;
        const std::array<double, 2> other = value(b, t, there.weights);
        expected = std::min(expected, std::hypot(own[0] - other[0], own[1] - other[1]));
      }
      CHECK(got == doctest::Approx(expected).epsilon(1e-9));
    }
  });
}
