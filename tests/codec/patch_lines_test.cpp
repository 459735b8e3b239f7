// Which edges of a block hold their vertices, by looking at all pairs of triangles.
#include "codec/patch_lines.h"

#include "codec/layer_values.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace crease::codec {
namespace {

using simplification::Quadric;

constexpr std::uint32_t kSide = 9;

// A hilly square of few categories and few values, with some triangles missing, turned over or
// twice there. Layer 0 is normals, layer 1 a number that is no part of any wedge. The last vertex
// has no triangles.
UnfoldedBlock random_block(std::mt19937_64& random) {
  UnfoldedBlock block;
  PatchMesh& mesh = block.end;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      mesh.positions.push_back(
          {std::int32_t(100 * x), std::int32_t(100 * y), std::int32_t(random() % 40)});
    }
  }
  mesh.positions.push_back({-5, -5, -5});
  for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = y * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
      for (Corners corners : {Corners{a, b, d}, Corners{a, d, c}}) {
        const std::uint64_t luck = random() % 40;
        if (luck == 0) continue;
        if (luck == 1) std::swap(corners[0], corners[1]);
        mesh.triangles.push_back(corners);
        if (luck == 2) mesh.triangles.push_back(corners);
      }
    }
  }
  const std::size_t triangles = mesh.triangles.size();
  mesh.values.assign(2, std::vector<CodedValue>(3 * triangles));
  for (std::size_t t = 0; t < triangles; ++t) {
    mesh.category.push_back(random() % 30 == 0);
    mesh.derived.push_back(random() % 30 == 0);
    const bool is_flat = random() % 10 == 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t own = is_flat ? 0 : std::int32_t(mesh.triangles[t][c]);
      mesh.values[0][3 * t + c] = {100 + (random() % 50 == 0 ? 90 : own), 90, 0, 0};
      mesh.values[1][3 * t + c] = {random() % 60 == 0, 0, 0, 0};
    }
  }
  block.vertices.resize(mesh.positions.size());
  block.triangles.resize(triangles);
  block.coarse_values.resize(block.end.values.size());
  return block;
}

bool is_face(const PatchMesh& mesh, std::size_t t) {
  const CodedValue* n = &mesh.values[0][3 * t];
  return mesh.derived[t] || (n[0] == n[1] && n[1] == n[2]);
}

bool is_smooth(const PatchMesh& mesh, const PatchGeometry& geometry, std::uint32_t t,
               std::uint32_t u, std::array<std::uint32_t, 2> edge) {
  if (mesh.category[t] != mesh.category[u]) return false;
  const auto same = [&](std::size_t l) {
    return std::all_of(edge.begin(), edge.end(), [&](std::uint32_t v) {
      return mesh.values[l][3 * t + corner_of(mesh.triangles[t], v)] ==
             mesh.values[l][3 * u + corner_of(mesh.triangles[u], v)];
    });
  };
  if (!same(1)) return false;
  if (is_face(mesh, t) && is_face(mesh, u)) {
    return dot(geometry.normal(t).unit, geometry.normal(u).unit) >= 0.866;
  }
  return mesh.derived[t] || mesh.derived[u] || same(0);
}

// The sum of squared lengths of the lines at each vertex that is contracted.
std::vector<double> weights_of_lines(const PatchMesh& mesh, const PatchGeometry& geometry,
                                     const std::vector<char>& is_contracted) {
  std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> at_edge;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [a, b] = std::minmax(mesh.triangles[t][c], mesh.triangles[t][(c + 1) % 3]);
      at_edge[{a, b}].push_back(t);
    }
  }
  std::vector<double> weights(mesh.positions.size(), 0);
  for (const auto& [edge, at] : at_edge) {
    if (at.size() == 2 && is_smooth(mesh, geometry, at[0], at[1], edge)) continue;
    const Vec3d along = geometry.place(edge[1]) - geometry.place(edge[0]);
    for (const std::uint32_t v : edge) {
      if (is_contracted[v]) weights[v] += double(at.size()) * dot(along, along);
    }
  }
  return weights;
}

}  // namespace

TEST_CASE("borders, creases and what is not a surface hold their vertices, nothing else does") {
  const LayerCoding normals{.kind = LayerCoding::Kind::Octahedral, .bits = 10, .components = {}};
  const LayerCoding numbers{.kind = LayerCoding::Kind::Exact, .bits = 0, .components = {}};
  const std::vector<LayerSchema> layers{{.name = "n",
                                         .role = AttributeRole::Normal,
                                         .interpolation = Interpolation::Direction,
                                         .dimension = 3,
                                         .coding = AttributeCoding::Octahedral,
                                         .bits = 10},
                                        {.name = "x"}};
  std::vector<LayerValues> values;
  values.emplace_back(normals, 3);
  values.emplace_back(numbers, 1);
  BlockCoding coding;
  coding.layers = {values[0].in_block(true), values[1].in_block(false)};
  std::size_t with_lines = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const UnfoldedBlock block = random_block(random);
    std::vector<char> contracted(block.end.positions.size()), face;
    for (char& is : contracted) is = random() % 4 != 0;
    for (std::size_t t = 0; t < block.end.triangles.size(); ++t) {
      face.push_back(is_face(block.end, t));
    }
    const PatchGeometry geometry(block.end);
    const ContractingPatch patch(block.end);
    const WedgeQuadrics wedges(block, layers, values, geometry, contracted);
    PatchLines lines(block, coding, patch, geometry, contracted, face, wedges);
    const std::vector<double> expected = weights_of_lines(block.end, geometry, contracted);
    const std::uint32_t alone = kSide * kSide;
    for (std::uint32_t v = 0; v < alone; ++v) {
      CAPTURE(v);
      const Quadric* const found = lines.join(v, alone);
      ++(found ? with_lines : without);
      REQUIRE((found ? found->weight : 0) == doctest::Approx(expected[v]));
      if (found) CHECK(found->at(geometry.place(v)) < 1e-6 * (1 + found->weight));
    }
  }
  CHECK(with_lines > 1000);
  CHECK(without > 1000);
}

}  // namespace crease::codec
