#include "crease/generate.h"
#include "crease/shading.h"
#include "generate/street_grid.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

using namespace crease;

namespace {

constexpr std::size_t kLarge = kSanitized ? 40'000 : 200'000;  // triangles

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

// Not what stands between them.
bool is_building(const std::string& part) {
  for (const char* other : {"trees", "shed", "block", "ground"}) {
    if (part.starts_with(other)) return false;
  }
  return true;
}

using Edge = std::pair<VertexId, VertexId>;

Edge edge(VertexId a, VertexId b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

struct Side {
  std::size_t triangle, corner;  // the side runs from this corner to the next
};

std::map<Edge, std::vector<Side>> sides_of_edges(const Mesh& mesh) {
  std::map<Edge, std::vector<Side>> sides;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& v = mesh.triangles[t];
    for (std::size_t c = 0; c < 3; ++c) sides[edge(v[c], v[(c + 1) % 3])].push_back({t, c});
  }
  return sides;
}

}  // namespace

TEST_CASE("a larger grid leaves the inner blocks where they are, and goes on beyond them") {
  const StreetGrid small = make_street_grid(1, kLastInnerBlock), large = make_street_grid(1, 170);
  CHECK(small.river_low == large.river_low);
  for (StreetAxis StreetGrid::*axis : {&StreetGrid::x, &StreetGrid::y}) {
    for (int i = -kLastInnerBlock; i <= kLastInnerBlock; ++i) {
      CHECK((small.*axis).at(i).low == (large.*axis).at(i).low);
      CHECK((small.*axis).at(i).high == (large.*axis).at(i).high);
    }
    REQUIRE((large.*axis).blocks.size() == 2 * 170 + 1);
    for (int i = -170; i < 170; ++i) CHECK((large.*axis).street_after(i) >= 9);
    // So that the order of blocks, by fourth powers of metres, does not overflow.
    CHECK(std::max(-(large.*axis).at(-170).low, (large.*axis).at(170).high) < 13'900);
  }
}

TEST_CASE("a city has the triangles that were asked for, within five percent") {
  for (std::size_t triangles : {10'000, 30'000, 100'000, 150'000, 300'000, 1'000'000}) {
    CAPTURE(triangles);
    const Mesh city = generate_city({.triangles = triangles});
    CHECK(check_mesh(city).ok());
    CHECK(double(city.triangle_count()) > 0.95 * double(triangles));
    CHECK(double(city.triangle_count()) < 1.05 * double(triangles));
  }
}

TEST_CASE("a city of a million triangles has four thousand buildings in all shading kinds") {
  const Mesh city = generate_city({});
  CHECK(std::ranges::count_if(city.parts, is_building) >= 4000);
  CHECK(city.materials.size() > 5);
  const ShadingKinds kinds = classify_shading(city);
  const auto share = [&](TriangleKind kind) {
    return double(std::ranges::count(kinds.of_triangle, kind)) / double(city.triangle_count());
  };
  CHECK(share(TriangleKind::FN) > 0.5);
  CHECK(share(TriangleKind::SN) > 0.03);
  CHECK(share(TriangleKind::NSN) > 0.05);
}

TEST_CASE("houses are small and landmarks large") {
  const Mesh city = generate_city({});
  std::vector<std::size_t> triangles(city.parts.size());
  for (PartId part : city.part_of_triangle) ++triangles[index_of(part)];
  std::size_t small = 0;
  for (std::size_t i = 0; i < city.parts.size(); ++i) {
    CAPTURE(city.parts[i]);
    CHECK(triangles[i] > 0);
    small += is_building(city.parts[i]) && triangles[i] >= 50 && triangles[i] <= 250;
    if (city.parts[i].starts_with("house")) CHECK(triangles[i] <= 350);
    if (city.parts[i].starts_with("church")) CHECK(triangles[i] >= 600);
    if (city.parts[i].starts_with("town hall")) CHECK(triangles[i] >= 2500);
    if (city.parts[i] == "cathedral") CHECK(triangles[i] >= 10'000);
  }
  CHECK(small > 2500);
}

// The hash stands here so that another compiler or processor that gives another city is noticed.
TEST_CASE("the same seed gives the same city, another seed another") {
  const std::uint64_t hash = hash_of(generate_city({.seed = 7, .triangles = 60'000}));
  CHECK(hash == hash_of(generate_city({.seed = 7, .triangles = 60'000})));
  CHECK(hash != hash_of(generate_city({.seed = 8, .triangles = 60'000})));
  CHECK(hash == 14949611256361485557u);
}

TEST_CASE("normals agree with the geometry, on flat faces exactly") {
  const Mesh city = generate_city({.triangles = kLarge});
  const AttributeLayer& normals = *city.normals();
  for (std::size_t t = 0; t < city.triangle_count(); ++t) {
    const Vec3d scaled = scaled_normal(city, t);
    CAPTURE(city.parts[index_of(city.part_of_triangle[t])]);
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

// So there are no T-junctions: at one of them an edge would have only one triangle.
TEST_CASE("every body is closed and manifold: each edge has two triangles, one each way") {
  const Mesh city = generate_city({.triangles = kLarge});
  for (const auto& edge : sides_of_edges(city)) {
    const auto runs_up = [&](const Side& s) {
      return city.triangles[s.triangle][s.corner] == edge.first.first;
    };
    const auto& sides = edge.second;
    CAPTURE(city.parts[index_of(city.part_of_triangle[sides[0].triangle])]);
    REQUIRE(sides.size() == 2);
    CHECK(runs_up(sides[0]) != runs_up(sides[1]));
  }
}

// Bodies that belong together run into each other; where two faces lay on each other, the same
// three points would come twice.
TEST_CASE("no triangle lies on another with the same corners") {
  const Mesh city = generate_city({.triangles = kLarge});
  std::map<std::array<std::array<double, 3>, 3>, int> count;
  for (const Triangle& v : city.triangles) {
    std::array<std::array<double, 3>, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d& p = city.positions[index_of(v[c])];
      corners[c] = {p.x, p.y, p.z};
    }
    std::ranges::sort(corners);
    ++count[corners];
  }
  CHECK(count.size() == city.triangle_count());
}

// Smooth: the two triangles share both normals on their edge, or at the tip of a cone, where each
// has its own, one. Hard: neither.
TEST_CASE("edges turn smoothly by little and sharply by much") {
  const Mesh city = generate_city({.triangles = kLarge});
  const std::vector<AttributeId>& normals = city.normals()->of_corner;
  std::size_t smooth = 0, hard = 0, flat = 0;
  for (const auto& edge : sides_of_edges(city)) {
    const auto& e = edge.first;
    const auto& sides = edge.second;
    REQUIRE(sides.size() == 2);
    const auto normal_at = [&](const Side& s, VertexId v) {
      const Triangle& corners = city.triangles[s.triangle];
      const std::size_t c = std::size_t(std::ranges::find(corners, v) - corners.begin());
      return normals[3 * s.triangle + c];
    };
    const int shared_ends = (normal_at(sides[0], e.first) == normal_at(sides[1], e.first)) +
                            (normal_at(sides[0], e.second) == normal_at(sides[1], e.second));
    const bool shared = shared_ends == 2;
    const Vec3d n = normalized(scaled_normal(city, sides[0].triangle));
    const Vec3d m = normalized(scaled_normal(city, sides[1].triangle));
    const double cosine = dot(n, m);
    CAPTURE(city.parts[index_of(city.part_of_triangle[sides[0].triangle])]);
    if (cosine > 1 - 1e-9) {
      flat += shared;
      continue;
    }
    if (shared) CHECK(cosine > std::cos(radians(62)));
    // Folds of buildings are of fifteen degrees and more; what turns by less is round.
    if (cosine > std::cos(radians(8))) CHECK(shared_ends > 0);
    (shared ? smooth : hard) += 1;
  }
  CHECK(flat > 20'000);
  CHECK(smooth > (kSanitized ? 3'000 : 20'000));
  CHECK(hard > 20'000);
}

TEST_CASE("positions are whole millimetres") {
  const Mesh city = generate_city({.triangles = 20'000});
  for (const Vec3d& p : city.positions) {
    for (int i = 0; i < 3; ++i) REQUIRE(p[i] == double(std::llround(p[i] * 1000)) / 1000);
  }
}
