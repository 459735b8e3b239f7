// How long it takes to find closest points on triangles whose boxes are much larger than they.
//
//   bench_closest [--cables 3000] [--samples 20000] [--rounds 3]
//
// Cables from anywhere in a cube to anywhere, against the same a little turned, and, as the
// baseline, as many along one axis, whose boxes are no larger than they need be. Medians of the
// rounds.
#include "crease/compare.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

namespace crease::bench {
namespace {

constexpr std::uint32_t kSides = 6;

Mesh cables(std::uint32_t count, bool is_askew, double width, double turn) {
  Mesh mesh;
  AttributeLayer normals{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
  std::mt19937 random(1);
  const auto any = [&random] { return double(random()) / double(std::mt19937::max()); };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3d from{any(), any(), any()}, other{any(), any(), any()};
    const Vec3d to = is_askew ? other : Vec3d{from.x, from.y, other.z};
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const auto first_normal = static_cast<std::uint32_t>(normals.values.size() / 3);
    const auto out = [&](double side) {
      const double angle = side * 2 * 3.14159265358979 / kSides + turn;
      return Vec3d{std::cos(angle), std::sin(angle), 0};
    };
    for (const Vec3d& end : {from, to}) {
      for (std::uint32_t k = 0; k < kSides; ++k) mesh.positions.push_back(end + out(k) * width);
    }
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const Vec3d n = out(k + 0.5);
      normals.values.insert(normals.values.end(), {float(n.x), float(n.y), float(n.z)});
      const auto at = [first](std::uint32_t v) { return VertexId{first + v}; };
      const std::uint32_t next = (k + 1) % kSides;
      mesh.triangles.push_back({at(k), at(next), at(kSides + k)});
      mesh.triangles.push_back({at(next), at(kSides + next), at(kSides + k)});
      normals.of_corner.insert(normals.of_corner.end(), 6, AttributeId{first_normal + k});
    }
  }
  mesh.layers.push_back(std::move(normals));
  return mesh;
}

int run(std::uint32_t count, std::size_t samples, int rounds) {
  std::array<std::vector<double>, 2> seconds;  // along an axis, askew
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Mesh a = cables(count, i == 1, 2e-4, 0), b = cables(count, i == 1, 2.1e-4, 0.3);
      const auto start = std::chrono::steady_clock::now();
      CompareOptions options;
      options.samples = samples;
      const Result<Comparison> apart = compare_meshes(a, b, options);
      if (!apart.ok()) return 1;
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
      seconds[i].push_back(passed.count());
      std::printf("%s: %zu triangles, %.2f s, mean distance %.3g\n",
                  i == 1 ? "askew" : "along an axis", a.triangle_count(), passed.count(),
                  apart->distance.a_to_b.mean);
    }
  }
  for (std::vector<double>& s : seconds) std::sort(s.begin(), s.end());
  const std::size_t middle = seconds[0].size() / 2;
  std::printf("askew over along an axis: %.2f\n", seconds[1][middle] / seconds[0][middle]);
  return 0;
}

}  // namespace
}  // namespace crease::bench

int main(int argc, char** argv) {
  CLI::App app("Closest points on long thin triangles that lie askew, beside such along an axis");
  std::uint32_t count = 3000;
  std::size_t samples = 20'000;
  int rounds = 3;
  app.add_option("--cables", count);
  app.add_option("--samples", samples);
  app.add_option("--rounds", rounds)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  return crease::bench::run(count, samples, rounds);
}
