// Charts of some triangles each, as photogrammetry makes them, stay where they are as long as there
// are triangles for it.
#include "base/mixed.h"
#include "simplify/reduce.h"
#include "support/mesh_builder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace crease {
namespace {

constexpr int kCells = 48, kOfChart = 2;

// A sheet with waves; every 2 x 2 squares have a chart anywhere in the texture.
Mesh sheet_of_charts() {
  MeshBuilder b;
  AttributeLayer uv{"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}};
  const AttributeId up = b.normal({0, 0, 1});
  const auto vertex = [&](int i, int j) {
    const double x = double(i) / kCells, y = double(j) / kCells;
    return b.at({x, y, 0.02 * std::sin(9 * x) * std::cos(11 * y)});
  };
  const auto value = [&](int chart, int i, int j) {
    const auto at = static_cast<std::uint32_t>(chart);
    const double u = double(mixed(2 * at)) * 0x1p-32 + double(i) / kCells;
    const double v = double(mixed(2 * at + 1)) * 0x1p-32 + double(j) / kCells;
    uv.values.push_back(static_cast<float>(u));
    uv.values.push_back(static_cast<float>(v));
    return AttributeId{static_cast<std::uint32_t>(uv.value_count() - 1)};
  };
  for (int y = 0; y < kCells; y += kOfChart) {
    for (int x = 0; x < kCells; x += kOfChart) {
      AttributeId at[kOfChart + 1][kOfChart + 1];
      for (int j = 0; j <= kOfChart; ++j) {
        for (int i = 0; i <= kOfChart; ++i) at[j][i] = value(y * kCells + x, i, j);
      }
      for (int j = 0; j < kOfChart; ++j) {
        for (int i = 0; i < kOfChart; ++i) {
          b.quad({vertex(x + i, y + j), vertex(x + i + 1, y + j), vertex(x + i + 1, y + j + 1),
                  vertex(x + i, y + j + 1)},
                 up);
          for (const AttributeId id : {at[j][i], at[j][i + 1], at[j + 1][i + 1], at[j][i],
                                       at[j + 1][i + 1], at[j + 1][i]}) {
            uv.of_corner.push_back(id);
          }
        }
      }
    }
  }
  Mesh mesh = b.take();
  mesh.layers.push_back(std::move(uv));
  return mesh;
}

}  // namespace

TEST_CASE("charts of one triangle each cost no more than none") {
  Mesh bare = sheet_of_charts();
  bare.layers.pop_back();
  Mesh tiled = bare;
  AttributeLayer uv{"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, {}, {}};
  for (std::uint32_t corner = 0; corner < 3 * tiled.triangle_count(); ++corner) {
    const double u = double(mixed(corner / 3)) * 0x1p-32 + 0.002 * (corner % 3 == 1);
    const double v = double(mixed(~(corner / 3))) * 0x1p-32 + 0.002 * (corner % 3 == 2);
    uv.of_corner.push_back(AttributeId{corner});
    uv.values.push_back(static_cast<float>(u));
    uv.values.push_back(static_cast<float>(v));
  }
  tiled.layers.push_back(std::move(uv));
  const Comparison with = reduce(tiled, tiled.triangle_count() / 4).apart;
  const Comparison without = reduce(bare, bare.triangle_count() / 4).apart;
  // 1.00 times; 1.27 where all edges are seams that count a little.
  CHECK(with.distance.b_to_a.mean < 1.1 * without.distance.b_to_a.mean);
}

TEST_CASE("charts of eight triangles stay where they are until each has two") {
  const Mesh mesh = sheet_of_charts();
  const Reached level = reduce(mesh, mesh.triangle_count() / 4);
  const auto uv = std::ranges::find(level.apart.attributes, "uv", &AttributeDeviation::name);
  REQUIRE(uv != level.apart.attributes.end());
  // 0.00003; 0.11 where seams of so many charts are hardly lines.
  CHECK(uv->spread.mean < 0.0001);
  CHECK(level.apart.distance.a_to_b.max < 0.001);
}

}  // namespace crease
