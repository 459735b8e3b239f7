#include "crease/generate.h"
#include "crease/shading.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

using namespace crease;

namespace {

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x100000001b3u;
}

// Over everything that a file of the city would hold.
std::uint64_t hash_of(const Mesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) hash = mix(hash, std::bit_cast<std::uint64_t>(p[i]));
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (VertexId v : mesh.triangles[t]) hash = mix(hash, index_of(v));
    hash = mix(hash, index_of(mesh.material_of_triangle[t]));
    hash = mix(hash, index_of(mesh.part_of_triangle[t]));
  }
  for (AttributeId n : mesh.layers[0].of_corner) hash = mix(hash, index_of(n));
  for (float x : mesh.layers[0].values) hash = mix(hash, std::bit_cast<std::uint32_t>(x));
  for (const std::string& name : mesh.parts) {
    for (char c : name) hash = mix(hash, static_cast<unsigned char>(c));
  }
  return hash;
}

Vec3d scaled_normal(const Mesh& mesh, std::size_t t) {
  const Vec3d a = mesh.positions[index_of(mesh.triangles[t][0])];
  return cross(mesh.positions[index_of(mesh.triangles[t][1])] - a,
               mesh.positions[index_of(mesh.triangles[t][2])] - a);
}

bool is_axis_parallel(std::span<const float> n) {
  return std::abs(std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]) - 1) < 1e-6;
}

}  // namespace

TEST_CASE("a city has the triangles that were asked for, within five percent") {
  for (std::size_t triangles : {10'000, 30'000, 100'000, 150'000, 300'000, 1'000'000}) {
    CAPTURE(triangles);
    const Mesh city = generate_city({.triangles = triangles});
    CHECK(check_mesh(city).ok());
    CHECK(double(city.triangle_count()) > 0.95 * double(triangles));
    CHECK(double(city.triangle_count()) < 1.05 * double(triangles));
  }
}

TEST_CASE("a city of a million triangles has thousands of buildings in all shading kinds") {
  const Mesh city = generate_city({});
  CHECK(city.parts.size() > 2000);
  CHECK(city.materials.size() > 5);
  const ShadingKinds kinds = classify_shading(city);
  const auto share = [&](TriangleKind kind) {
    return double(std::ranges::count(kinds.of_triangle, kind)) / double(city.triangle_count());
  };
  CHECK(share(TriangleKind::FN) > 0.5);
  CHECK(share(TriangleKind::SN) > 0.03);
  CHECK(share(TriangleKind::NSN) > 0.05);
}

// The hash stands here so that another compiler or processor that gives another city is noticed.
TEST_CASE("the same seed gives the same city, another seed another") {
  const std::uint64_t hash = hash_of(generate_city({.seed = 7, .triangles = 60'000}));
  CHECK(hash == hash_of(generate_city({.seed = 7, .triangles = 60'000})));
  CHECK(hash != hash_of(generate_city({.seed = 8, .triangles = 60'000})));
  CHECK(hash == 16744989627464202713u);
}

TEST_CASE("normals agree with the geometry, on flat faces exactly") {
  const Mesh city = generate_city({.triangles = 200'000});
  const AttributeLayer& normals = *city.normals();
  for (std::size_t t = 0; t < city.triangle_count(); ++t) {
    const Vec3d scaled = scaled_normal(city, t);
    REQUIRE(length(scaled) > 0);
    const AttributeId* n = &normals.of_corner[3 * t];
    for (int c = 0; c < 3; ++c) {
      const std::span<const float> value = normals.value(n[c]);
      const double cosine = dot(normalized(scaled), Vec3d{value[0], value[1], value[2]});
      REQUIRE(cosine > 0.5);
      if (n[0] == n[1] && n[1] == n[2]) REQUIRE(cosine > 1 - 1e-7);
      if (n[0] == n[1] && n[1] == n[2] && is_axis_parallel(value)) {
        REQUIRE(cosine == doctest::Approx(1).epsilon(1e-12));
      }
    }
  }
}

TEST_CASE("every building is closed: each edge runs as often one way as the other") {
  const Mesh city = generate_city({.triangles = 200'000});
  std::map<std::pair<VertexId, VertexId>, int> balance;
  for (std::size_t t = 0; t < city.triangle_count(); ++t) {
    if (city.parts[index_of(city.part_of_triangle[t])] == "ground") continue;
    const Triangle& v = city.triangles[t];
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId from = v[c], to = v[(c + 1) % 3];
      from < to ? ++balance[{from, to}] : --balance[{to, from}];
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, count] : balance) open += count != 0;
  CHECK(open == 0);
}

TEST_CASE("positions are whole millimetres") {
  const Mesh city = generate_city({.triangles = 20'000});
  for (const Vec3d& p : city.positions) {
    for (int i = 0; i < 3; ++i) REQUIRE(p[i] == double(std::llround(p[i] * 1000)) / 1000);
  }
}
