// The cases in which simplifiers stop short or lose the shading, as tests of shape:
// counts of triangles and degrees, never time.
#include "crease/compare.h"
#include "crease/simplify.h"
#include "mesh/normals.h"
#include "simplify/reduce.h"
#include "support/hashed.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>

using namespace crease;

namespace {

double relative(double distance, const Reached& reached) {
  return distance / reached.apart.diagonal;
}

// Every triangle as four, each with its triangle's normals: flat meshes only.
Mesh quartered(const Mesh& mesh) {
  Mesh fine = mesh;
  fine.triangles.clear();
  AttributeLayer& normals = fine.layers[0];
  normals.of_corner.clear();
  std::map<std::pair<VertexId, VertexId>, VertexId> middles;
  const auto middle = [&](VertexId a, VertexId b) {
    const auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                  VertexId{std::uint32_t(fine.positions.size())});
    if (is_new) {
      fine.positions.push_back((fine.positions[index_of(a)] + fine.positions[index_of(b)]) * 0.5);
    }
    return at->second;
  };
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const VertexId ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& part :
         {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      fine.triangles.push_back(part);
      normals.of_corner.insert(normals.of_corner.end(), 3, mesh.layers[0].of_corner[3 * t]);
    }
  }
  return fine;
}

// A layer with a value of its own for every triangle or, of two numbers, for every corner's place
// in its triangle's chart.
AttributeLayer value_a_triangle(const Mesh& mesh, AttributeRole role, std::uint8_t dimension) {
  AttributeLayer layer{.name = "own",
                       .role = role,
                       .interpolation = Interpolation::Linear,
                       .dimension = dimension,
                       .values = {},
                       .of_corner = {}};
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const bool is_chart = role == AttributeRole::TexCoord;
      if (is_chart || c == 0) {
        for (std::uint32_t i = 0; i < dimension; ++i) {
          const std::uint32_t mixed = (t * 3 + i) * 2654435761u;  // Knuth's multiplicative hash
          const float corner = is_chart && c == i + 1 ? 0.01f : 0.0f;
          layer.values.push_back(static_cast<float>(mixed >> 8) * 0x1p-24f + corner);
        }
      }
      layer.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(layer.value_count() - 1)});
    }
  }
  return layer;
}

// Edges by how many triangles meet there.
std::map<std::size_t, std::size_t> edges_by_valence(const Mesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, std::size_t> triangles_of_edge;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId a = t[c], b = t[(c + 1) % 3];
      ++triangles_of_edge[{std::min(a, b), std::max(a, b)}];
    }
  }
  std::map<std::size_t, std::size_t> edges;
  for (const auto& [edge, count] : triangles_of_edge) ++edges[count];
  return edges;
}

}  // namespace

TEST_CASE("a faceted sphere reaches 10 % and stays a sphere with facets") {
  const Mesh sphere = faceted_sphere(45, 45);
  const Reached reached = reduce(sphere, sphere.triangle_count() / 10);
  CHECK(reached.triangles <= sphere.triangle_count() / 10);
  CHECK(reached.triangles >= sphere.triangle_count() / 10 - 4);
  CHECK(relative(reached.apart.distance.a_to_b.mean, reached) < 2e-3);
  CHECK(reached.apart.normal_deviation.mean < 8);
}

TEST_CASE("a box goes to 12 triangles and loses nothing") {
  const Reached reached = reduce(hard_box(24), 12);
  CHECK(reached.triangles == 12);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
  CHECK(relative(reached.apart.distance.b_to_a.max, reached) < 1e-6);
  CHECK(reached.apart.normal_deviation.max < 1e-3);
}

TEST_CASE("a cylinder at 10 % keeps its rims") {
  const Mesh cylinder = hard_cylinder(64, 30);
  const Reached reached = reduce(cylinder, cylinder.triangle_count() / 10);
  CHECK(reached.triangles <= cylinder.triangle_count() / 10);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-4);
  CHECK(reached.apart.normal_deviation.mean < 0.05);
}

TEST_CASE("a box with half a degree of noise is a box once its normals are joined") {
  Mesh box = noisy_box(24, 0.5);
  join_normals(*box.normals(), box, 1);
  const Reached reached = reduce(box, 12);
  CHECK(reached.triangles == 12);
  CHECK(relative(reached.apart.distance.b_to_a.max, reached) < 1e-6);
  CHECK(reached.apart.normal_deviation.max < 1e-3);
}

// As exports from left-handed systems have it: the normals are right, and every triangle is wound
// the other way.
TEST_CASE("a model that is wound against its normals is simplified as any other") {
  const auto turned = [](Mesh mesh) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
      AttributeId* corners = &mesh.layers[0].of_corner[3 * t];
      std::swap(corners[1], corners[2]);
    }
    return mesh;
  };
  const Reached box = reduce(turned(hard_box(24)), 12);
  CHECK(box.triangles == 12);
  CHECK(relative(box.apart.distance.b_to_a.max, box) < 1e-6);
  CHECK(box.apart.normal_deviation.max < 1e-3);
  const Mesh wheel = quartered(quartered(gear(40)));
  const Reached gear = reduce(turned(wheel), wheel.triangle_count() / 10);
  CHECK(gear.triangles <= wheel.triangle_count() / 10);
  CHECK(relative(gear.apart.distance.a_to_b.max, gear) < 1e-6);
  CHECK(gear.apart.normal_deviation.max < 1e-3);
}

// Both sides of every sheet, as two-sided exports have them, or every triangle twice.
TEST_CASE("a model that has every triangle twice is simplified as any other") {
  for (const bool other_side : {false, true}) {
    CAPTURE(other_side);
    Mesh box = hard_box(16);
    AttributeLayer& normals = box.layers[0];
    const std::size_t triangles = box.triangle_count(), values = normals.value_count();
    if (other_side) {
      for (std::size_t i = 0; i < 3 * values; ++i) normals.values.push_back(-normals.values[i]);
    }
    const auto copied = [&](std::size_t t, std::size_t c) {
      const std::size_t id = index_of(normals.of_corner[3 * t + c]) + (other_side ? values : 0);
      return AttributeId{static_cast<std::uint32_t>(id)};
    };
    for (std::size_t t = 0; t < triangles; ++t) {
      Triangle copy = box.triangles[t];
      std::array<AttributeId, 3> ids{copied(t, 0), copied(t, 1), copied(t, 2)};
      if (other_side) {
        std::swap(copy[1], copy[2]);
        std::swap(ids[1], ids[2]);
      }
      box.triangles.push_back(copy);
      normals.of_corner.insert(normals.of_corner.end(), ids.begin(), ids.end());
    }
    const Reached reached = reduce(box, 24);
    CHECK(reached.triangles == 24);
    CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
    CHECK(relative(reached.apart.distance.b_to_a.max, reached) < 1e-6);
  }
}

// Noise of normals, values and charts by triangle: what differs at every edge makes no lines there.
TEST_CASE("a box whose attributes differ at every edge keeps its shape") {
  struct Case {
    std::string what;
    Mesh mesh;
  };
  Mesh numbered = hard_box(24), coloured = hard_box(24), charts = hard_box(24);
  numbered.layers.push_back(value_a_triangle(numbered, AttributeRole::Other, 1));
  coloured.layers.push_back(value_a_triangle(coloured, AttributeRole::Color, 3));
  charts.layers.push_back(value_a_triangle(charts, AttributeRole::TexCoord, 2));
  const Case cases[] = {{"corners' normals off by up to 0.02 degrees", noisy_box(24, 0.02)},
                        {"corners' normals off by up to a degree", noisy_box(24, 1)},
                        {"a number a triangle", std::move(numbered)},
                        {"a colour a triangle", std::move(coloured)},
                        {"a chart a triangle", std::move(charts)}};
  for (const Case& c : cases) {
    CAPTURE(c.what);
    const Reached reached = reduce(c.mesh, 100);
    CHECK(reached.triangles <= 100);
    CHECK(reached.triangles >= 96);
    CHECK(relative(reached.apart.distance.a_to_b.mean, reached) < 5e-4);
    CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-2);
    CHECK(reached.apart.normal_deviation.mean < 1);
  }
}

// Each tile is a part of two triangles that has none to give: they have to join.
TEST_CASE("a roof of tiles beside something larger stays a roof") {
  constexpr int kTiles = 20;
  MeshBuilder builder;
  for (int y = 0; y < kTiles; ++y) {
    for (int x = 0; x < kTiles; ++x) {  // a little apart, and not quite in one plane
      builder.grid({x + 0.005, y + 0.005, 1e-3 * ((x + y) % 2)}, {0.99, 0, 0}, {0, 0.99, 0}, 1, 1);
    }
  }
  builder.box({-10, 0, 0}, {-2, 8, 8}, 16);
  const Mesh mesh = builder.take();
  const Reached reached = reduce(mesh, mesh.triangle_count() / 20);
  double area = 0;
  for (const Triangle& t : reached.mesh.triangles) {
    const auto at = [&](std::size_t c) { return reached.mesh.positions[index_of(t[c])]; };
    if (at(0).x > -1) area += 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
  }
  CHECK(area > 0.95 * kTiles * kTiles);
  CHECK(area < 1.05 * kTiles * kTiles);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 2e-3);
}

// Of a number, from -0.5 to 0.5.
double around_zero(std::uint32_t x) {
  return hashed(x) - 0.5;
}

// Beside the ground they have hardly any area.
TEST_CASE("posts on rough ground stand as long as the ground is rough") {
  constexpr int kSide = 40, kPosts = 3, kCorners = 6, kStoreys = 4;
  MeshBuilder builder;
  const auto ground = [](int x, int y) {
    return Vec3d{double(x), double(y), 0.2 * around_zero(std::uint32_t(x * kSide + y))};
  };
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const VertexId at[] = {builder.at(ground(x, y)), builder.at(ground(x + 1, y)),
                             builder.at(ground(x + 1, y + 1)), builder.at(ground(x, y + 1))};
      builder.flat_triangle({at[0], at[1], at[2]});
      builder.flat_triangle({at[0], at[2], at[3]});
    }
  }
  for (int post = 0; post < kPosts * kPosts; ++post) {
    const auto at = [&](int corner, int storey) {
      const double angle = 2 * std::numbers::pi * (corner % kCorners) / kCorners;
      return builder.at({10.5 * (post % kPosts + 1) + 0.05 * std::cos(angle),
                         10.5 * (post / kPosts + 1) + 0.05 * std::sin(angle), double(storey)});
    };
    for (int i = 0; i < kCorners; ++i) {
      for (int j = 0; j < kStoreys; ++j) {
        const VertexId v[] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        builder.flat_triangle({v[0], v[1], v[2]});
        builder.flat_triangle({v[0], v[2], v[3]});
      }
    }
  }
  const Mesh mesh = builder.take();
  const Reached reached = reduce(mesh, mesh.triangle_count() / 10);
  CHECK(reached.apart.distance.a_to_b.max < 0.5);
}

TEST_CASE("leaves vanish one by one before they join to something else") {
  constexpr int kLeaves = 600;
  MeshBuilder builder;
  for (std::uint32_t leaf = 0; leaf < kLeaves; ++leaf) {
    const auto vector = [&](std::uint32_t first) {
      return Vec3d{around_zero(9 * leaf + first), around_zero(9 * leaf + first + 1),
                   around_zero(9 * leaf + first + 2)};
    };
    const Vec3d u = normalized(vector(3)), v = normalized(cross(u, vector(6)));
    builder.grid(vector(0) * 10, u * 0.4, v * 0.4, 1, 1);
  }
  const Mesh mesh = builder.take();
  const Reached reached = reduce(mesh, mesh.triangle_count() / 2);
  CHECK(reached.apart.distance.b_to_a.max < 0.2);
  CHECK(reached.apart.normal_deviation.mean < 25);
}

// A scan's: holes that are smaller than what the level shows close, where they once swelled.
TEST_CASE("a sphere's pinholes close and its window stays") {
  Mesh sphere = smooth_sphere(60, 60);
  AttributeLayer& normals = sphere.layers[0];
  std::size_t kept = 0;
  for (std::size_t t = 0; t < sphere.triangle_count(); ++t) {
    const Vec3d at = sphere.positions[index_of(sphere.triangles[t][0])];
    if (t % 97 == 50 || length(at - Vec3d{0, 0.8, 0.6}) < 0.3) continue;
    sphere.triangles[kept] = sphere.triangles[t];
    std::copy_n(&normals.of_corner[3 * t], 3, &normals.of_corner[3 * kept]);
    ++kept;
  }
  sphere.triangles.resize(kept);
  normals.of_corner.resize(3 * kept);
  REQUIRE(edges_by_valence(sphere)[1] > 150);
  const Reached reached = reduce(sphere, kept / 20);
  const std::size_t border = edges_by_valence(reached.mesh)[1];
  CHECK(border >= 5);
  CHECK(border <= 25);
  CHECK(relative(reached.apart.distance.b_to_a.max, reached) < 0.03);
}

TEST_CASE("crossing walls go down to what the joints need, and the joints stay whole") {
  constexpr int kWalls = 4;
  const Mesh walls = crossing_walls(kWalls, 12);
  // Each wall of either direction falls into kWalls + 1 rectangles.
  const Reached reached = reduce(walls, 2 * kWalls * (kWalls + 1) * 2);
  CHECK(reached.triangles <= 2 * kWalls * (kWalls + 1) * 2);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
  CHECK(relative(reached.apart.distance.b_to_a.max, reached) < 1e-6);
  CHECK(reached.apart.normal_deviation.max < 1e-3);
  // Every joint is one edge of four triangles: none has come apart into edges of two.
  CHECK(edges_by_valence(reached.mesh)[4] == kWalls * kWalls);
}

TEST_CASE("a tessellated gear at 10 % is still the gear") {
  const Mesh wheel = quartered(quartered(gear(40)));
  const Reached reached = reduce(wheel, wheel.triangle_count() / 10);
  CHECK(reached.triangles <= wheel.triangle_count() / 10);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
  CHECK(reached.apart.normal_deviation.max < 1e-3);
}

TEST_CASE("city blocks go to 12 triangles each") {
  const Reached reached = reduce(city_blocks(6, 4), 36 * 12);
  CHECK(reached.triangles == 36 * 12);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
  CHECK(reached.apart.normal_deviation.max < 1e-3);
}

TEST_CASE("a corner of many sectors keeps every sector's normal") {
  constexpr int kSectors = 12;
  const Reached reached = reduce(sector_fan(kSectors, 6), kSectors);
  CHECK(reached.triangles <= kSectors);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
  CHECK(reached.apart.normal_deviation.max < 1e-3);
}

// A sliver of the sheet carries the opposite normal, as raw exports have them.
//   3---5---2
//   |  \|/  |    4 lies a hair above the edge 0-1; 0-1-4 is the sliver.
//   0===4===1
TEST_CASE("a sliver with a wrong normal does not swell over the sheet") {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0.2, 0}, {0, 0.2, 0}, {0.5, 1e-4, 0}, {0.5, 0.2, 0}};
  const auto at = [](unsigned a, unsigned b, unsigned c) {
    return Triangle{VertexId{a}, VertexId{b}, VertexId{c}};
  };
  mesh.triangles = {at(0, 1, 4), at(1, 2, 4), at(2, 5, 4), at(5, 3, 4), at(3, 0, 4)};
  mesh.layers.push_back({.name = "normal",
                         .role = AttributeRole::Normal,
                         .interpolation = Interpolation::Direction,
                         .dimension = 3,
                         .values = {0, 0, 1, 0, 0, -1},
                         .of_corner = {}});
  for (unsigned t = 0; t < 5; ++t) {
    mesh.layers[0].of_corner.insert(mesh.layers[0].of_corner.end(), 3, AttributeId{t == 0});
  }
  const Reached reached = reduce(mesh, 3);
  CHECK(relative(reached.apart.distance.a_to_b.mean, reached) < 1e-4);
  CHECK(reached.apart.normal_deviation.mean < 1);
}

// Rows of boxes; at corners of each a second vertex with two triangles to corners of the same box
// that have no area, as city models have them where a coordinate was rounded.
TEST_CASE("a triangle without area opens nowhere") {
  const Mesh box = hard_box(1);
  Mesh mesh = box;
  mesh.positions.clear();
  mesh.triangles.clear();
  AttributeLayer& normals = mesh.layers[0];
  const std::vector<AttributeId> of_corner = std::exchange(normals.of_corner, {});
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    normals.of_corner.insert(normals.of_corner.end(), 3, of_corner[0]);
  };
  const std::size_t corners = box.positions.size();
  for (int i = 0; i < 60; ++i) {
    const std::size_t first = mesh.positions.size();
    const Vec3d to{2.0 * (i % 8), 2.0 * (i / 8), 0};
    for (const Vec3d& p : box.positions) mesh.positions.push_back(p + to);
    for (const Triangle& t : box.triangles) {
      mesh.triangles.push_back({VertexId(index_of(t[0]) + first), VertexId(index_of(t[1]) + first),
                                VertexId(index_of(t[2]) + first)});
    }
    normals.of_corner.insert(normals.of_corner.end(), of_corner.begin(), of_corner.end());
    for (std::size_t c = 0; c < corners; ++c) {
      mesh.positions.push_back(mesh.positions[first + c]);
      const std::size_t second = mesh.positions.size() - 1;
      add(first + c, second, first + (c + 3) % corners);
      add(second, first + c, first + (c + 5) % corners);
    }
  }
  const Reached reached = reduce(mesh, mesh.triangle_count() - 60 * corners);
  CHECK(relative(reached.apart.distance.a_to_b.max, reached) < 1e-6);
  CHECK(relative(reached.apart.distance.b_to_a.max, reached) < 1e-6);
}

TEST_CASE("every zoo mesh goes all the way down") {
  for (const ZooMesh& z : mesh_zoo()) {
    CAPTURE(z.name);
    Mesh mesh = z.mesh;
    const Grid grid = make_grid(mesh, {});
    snap(mesh, grid);
    SimplifyStatistics statistics;
    const Result<ContractionSequence> sequence = simplify(mesh, grid, {}, &statistics);
    REQUIRE(sequence.ok());
    const Level base = apply_contractions(mesh, *sequence, sequence->contractions.size());
    CHECK(std::count(base.alive.begin(), base.alive.end(), true) <= 4);
  }
}

// Each vertex has triangles all over: whatever the patches, borders go through nearly all of them.
TEST_CASE("a tangle whose vertices all lie on borders of patches goes all the way down") {
  struct Tangle {
    std::size_t vertices, triangles;
    std::uint32_t patch_triangles;
  };
  for (const Tangle& tangle : {Tangle{23, 46, 24}, Tangle{100, 600, 24}, Tangle{60, 600, 150},
                               Tangle{1'000, 9'000, 8'000}}) {
    CAPTURE(tangle.triangles);
    if (kSanitized && tangle.triangles > 1'000) continue;
    Mesh mesh = random_complex(1, tangle.vertices, tangle.triangles);
    const Grid grid = make_grid(mesh, {.length = 0, .bits = 12});
    snap(mesh, grid);
    SimplifyStatistics statistics;
    const auto sequence = simplify(
        mesh, grid, {.patch_triangles = tangle.patch_triangles, .progress = {}}, &statistics);
    REQUIRE(sequence.ok());
    CHECK(statistics.bands.size() < 60);
    // What is left are triangles of the same three vertices.
    std::set<VertexId> used;
    const Level base = apply_contractions(mesh, *sequence, sequence->contractions.size());
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (base.alive[t]) used.insert(base.triangles[t].begin(), base.triangles[t].end());
    }
    CHECK(used.size() == 3);
  }
}
