// No face of a building lies on another of the same building: solids that belong together run into
// each other or apart.
#include "crease/generate.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

using namespace crease;

namespace {

using Int = std::int64_t;
using Point = std::array<Int, 3>;  // millimetres
using Plane = std::array<Int, 4>;  // normal without common factors, and offset

Point in_millimetres(const Vec3d& p) {
  return {std::llround(p.x * 1000), std::llround(p.y * 1000), std::llround(p.z * 1000)};
}

// Of both sides alike. Exact: a building is less than 2^18 mm long and less than 2^22 mm from the
// middle, and the ground, which is longer, has only planes along the axes.
Plane plane_of(const std::array<Point, 3>& p) {
  Point u, v;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = p[1][i] - p[0][i];
    v[i] = p[2][i] - p[0][i];
  }
  Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  Int factor = std::gcd(std::gcd(n[0], n[1]), n[2]);
  if (std::tie(n[0], n[1], n[2]) < std::make_tuple(Int{}, Int{}, Int{})) factor = -factor;
  Int offset = 0;
  for (std::size_t i = 0; i < 3; ++i) offset += (n[i] /= factor) * p[0][i];
  return {n[0], n[1], n[2], offset};
}

using Flat = std::array<std::array<double, 2>, 3>;

Flat seen_along_normal(const std::array<Point, 3>& p, const Plane& plane) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(plane[i]) > std::abs(plane[axis])) axis = i;
  }
  Flat flat;
  for (std::size_t c = 0; c < 3; ++c) {
    flat[c] = {double(p[c][(axis + 1) % 3]), double(p[c][(axis + 2) % 3])};
  }
  return flat;
}

// By more than 2 mm: no line along a side of `a` has all of `b` on its other side.
bool reaches_into(const Flat& a, const Flat& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &from = a[i], &to = a[(i + 1) % 3];
    const double ex = to[0] - from[0], ey = to[1] - from[1], length = std::hypot(ex, ey);
    const auto range = [&](const Flat& f) {
      double low = 1e300, high = -1e300;
      for (const auto& p : f) {
        const double at = (ex * p[1] - ey * p[0]) / length;
        low = std::min(low, at);
        high = std::max(high, at);
      }
      return std::pair(low, high);
    };
    const auto [a_low, a_high] = range(a);
    const auto [b_low, b_high] = range(b);
    if (a_high <= b_low + 2 || b_high <= a_low + 2) return false;
  }
  return true;
}

bool overlap(const Flat& a, const Flat& b) {
  return reaches_into(a, b) && reaches_into(b, a);
}

// Pairs of triangles of one part that share more than a border.
std::size_t overlapping_pairs(const Mesh& mesh, std::vector<std::string>& where) {
  std::map<std::pair<PartId, Plane>, std::vector<Flat>> faces;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<Point, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = in_millimetres(mesh.positions[index_of(mesh.triangles[t][c])]);
    }
    const Plane plane = plane_of(p);
    faces[{mesh.part_of_triangle[t], plane}].push_back(seen_along_normal(p, plane));
  }
  std::size_t count = 0;
  for (const auto& [key, flats] : faces) {
    const std::size_t before = count;
    for (std::size_t i = 0; i < flats.size(); ++i) {
      for (std::size_t j = i + 1; j < flats.size(); ++j) count += overlap(flats[i], flats[j]);
    }
    if (count > before) where.push_back(mesh.parts[index_of(key.first)]);
  }
  return count;
}

}  // namespace

TEST_CASE("no two faces of a part overlap in one plane") {
  for (std::uint32_t seed : {1u, 2u}) {
    CAPTURE(seed);
    std::vector<std::string> where;
    CHECK(overlapping_pairs(
              generate_city({.seed = seed, .triangles = kSanitized ? 60'000u : 400'000u}), where) ==
          0);
    for (std::size_t i = 0; i < std::min<std::size_t>(where.size(), 20); ++i) MESSAGE(where[i]);
  }
}

// A quad twice, the second time moved by a tenth of its length.
TEST_CASE("faces that do overlap are found") {
  Mesh mesh;
  mesh.parts = {"both"};
  for (double x : {0.0, 0.1}) {
    const auto first = VertexId(mesh.vertex_count());
    for (const Vec3d& p : {Vec3d{x, 0, 0}, Vec3d{x + 1, 0, 0}, Vec3d{x, 1, 0}}) {
      mesh.positions.push_back(p);
    }
    const auto at = [&](std::size_t i) { return VertexId(index_of(first) + i); };
    mesh.triangles.push_back({at(0), at(1), at(2)});
    mesh.part_of_triangle.push_back(PartId(0));
  }
  std::vector<std::string> where;
  CHECK(overlapping_pairs(mesh, where) == 1);
  for (std::size_t i = 3; i < 6; ++i) mesh.positions[i].z = 0.01;
  CHECK(overlapping_pairs(mesh, where) == 0);
}
