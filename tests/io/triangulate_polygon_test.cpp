#include "io/triangulate_polygon.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace crease {
namespace {

// A point of the plane z = 0.3 x - 0.2 y, so that nothing is axis-aligned.
Vec3d tilted(double x, double y) {
  return {x, y, 0.3 * x - 0.2 * y};
}
const Vec3d kTilted = normalized(Vec3d{-0.3, 0.2, 1});

std::vector<Vec3d> ring(std::initializer_list<std::pair<double, double>> corners) {
  std::vector<Vec3d> points;
  for (const auto& [x, y] : corners) points.push_back(tilted(x, y));
  return points;
}

double signed_area(const std::vector<Vec3d>& p, const std::array<std::uint32_t, 3>& t) {
  return 0.5 * dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), kTilted);
}

// Every edge of a ring lies on one triangle, every other edge on two that run it in opposite ways.
bool fits_together(const PolygonTriangles& cut, std::size_t border_edges) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& t : cut.triangles) {
    for (std::size_t c = 0; c < 3; ++c) ++uses[{t[c], t[(c + 1) % 3]}];
  }
  std::size_t unmatched = 0;
  for (const auto& [edge, count] : uses) {
    if (count != 1) return false;
    if (!uses.contains({edge.second, edge.first})) ++unmatched;
  }
  return unmatched == border_edges;
}

// All the promises at once, for a polygon without self-intersection.
void check_cut(const std::vector<Vec3d>& points, const std::vector<std::uint32_t>& holes,
               double area) {
  const PolygonTriangles cut = triangulate_polygon(points, holes);
  CHECK_FALSE(cut.fanned);
  CHECK(cut.triangles.size() == points.size() - 2 + 2 * holes.size());
  double sum = 0;
  for (const auto& t : cut.triangles) {
    const double a = signed_area(points, t);
    CHECK(a > -1e-12);
    sum += a;
  }
  CHECK(sum == doctest::Approx(area).epsilon(1e-9));
  CHECK(fits_together(cut, points.size()));
}

double ring_area(const std::vector<Vec3d>& points) {
  return 0.5 * dot(newell_normal(points), kTilted);
}

std::vector<Vec3d> star(std::mt19937& random, std::size_t corners, double x, double y,
                        double radius) {
  std::uniform_real_distribution<double> share(0.2, 1.0);
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * kPi * double(i) / double(corners);
    const double r = radius * share(random);
    points.push_back(tilted(x + r * std::cos(angle), y + r * std::sin(angle)));
  }
  return points;
}

}  // namespace

TEST_CASE("a convex polygon keeps its corners' order") {
  const auto square = ring({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  check_cut(square, {}, ring_area(square));
  const auto pentagon = ring({{0, 0}, {2, 0}, {3, 1}, {1, 3}, {-1, 1}});
  check_cut(pentagon, {}, ring_area(pentagon));
  CHECK(triangulate_polygon(pentagon).triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
}

TEST_CASE("a concave quadrilateral is cut at its reflex corner") {
  const auto arrow = ring({{0, 0}, {2, -1}, {0.5, 0}, {2, 1}});
  check_cut(arrow, {}, ring_area(arrow));
}

TEST_CASE("collinear points are kept as corners") {
  const auto points = ring({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {1, 3}, {0, 3}});
  check_cut(points, {}, ring_area(points));
  // A triangle with points on one of its edges: a fan from the wrong corner has no area.
  const auto triangle = ring({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 3}});
  check_cut(triangle, {}, ring_area(triangle));
}

TEST_CASE("a polygon that runs clockwise gives clockwise triangles") {
  auto points = ring({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});
  std::ranges::reverse(points);
  const PolygonTriangles cut = triangulate_polygon(points);
  CHECK(cut.triangles.size() == 3);
  for (const auto& t : cut.triangles) CHECK(signed_area(points, t) < 0);
}

TEST_CASE("holes are left out, whichever way they run") {
  for (const bool reversed : {false, true}) {
    std::vector<Vec3d> points = ring({{0, 0}, {10, 0}, {10, 10}, {0, 10}});
    std::vector<std::uint32_t> holes;
    double area = ring_area(points);
    for (const double x : {1.0, 4.0, 7.0}) {
      for (const double y : {1.0, 4.0, 7.0}) {
        auto hole = ring({{x, y}, {x + 2, y}, {x + 2, y + 2}, {x, y + 2}});
        area -= ring_area(hole);
        if (reversed) std::ranges::reverse(hole);
        holes.push_back(static_cast<std::uint32_t>(points.size()));
        points.insert(points.end(), hole.begin(), hole.end());
      }
    }
    check_cut(points, holes, area);
  }
}

TEST_CASE("a hole that touches the outer ring in a vertex is left out") {
  std::vector<Vec3d> points = ring({{0, 0}, {5, 0}, {10, 0}, {10, 10}, {0, 10}});
  const auto hole = ring({{5, 0}, {3, 4}, {7, 4}});
  const double area = ring_area(points) + ring_area(hole);  // the hole runs clockwise
  points.insert(points.end(), hole.begin(), hole.end());
  const std::uint32_t holes[] = {5};
  const PolygonTriangles cut = triangulate_polygon(points, holes);
  CHECK_FALSE(cut.fanned);
  double sum = 0;
  for (const auto& t : cut.triangles) {
    CHECK(signed_area(points, t) > -1e-12);
    sum += signed_area(points, t);
  }
  CHECK(sum == doctest::Approx(area));
}

TEST_CASE("repeated points and spikes cost nothing but themselves") {
  const auto points =
      ring({{0, 0}, {0, 0}, {4, 0}, {4, 4}, {4, 6}, {4, 4}, {2, 1}, {2, 1}, {0, 4}, {0, 0}});
  const PolygonTriangles cut = triangulate_polygon(points);
  CHECK_FALSE(cut.fanned);
  double sum = 0;
  for (const auto& t : cut.triangles) {
    CHECK(signed_area(points, t) > -1e-12);
    sum += signed_area(points, t);
  }
  CHECK(sum == doctest::Approx(ring_area(points)));
}

TEST_CASE("a slightly bent polygon is cut as its projection") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bump(-0.02, 0.02);
  auto points = star(random, 40, 0, 0, 1);
  const double area = ring_area(points);
  for (Vec3d& p : points) p += kTilted * bump(random);
  const PolygonTriangles cut = triangulate_polygon(points);
  CHECK_FALSE(cut.fanned);
  double sum = 0;
  for (const auto& t : cut.triangles) sum += signed_area(points, t);
  CHECK(sum == doctest::Approx(area));
  CHECK(fits_together(cut, points.size()));
}

TEST_CASE(
    "a polygon that crosses itself is fanned, and says so; one without area keeps its corners") {
  const auto bow_tie = ring({{0, 0}, {2, 2}, {2, 0}, {0, 2.5}});
  CHECK(triangulate_polygon(bow_tie).fanned);
  const auto line = ring({{0, 0}, {1, 1}, {2, 2}, {3, 3}});
  CHECK(triangulate_polygon(line).triangles.size() == 2);
  CHECK(triangulate_polygon(ring({{0, 0}, {1, 0}})).triangles.empty());
}

TEST_CASE("city coordinates lose nothing") {
  auto points = ring({{0, 0}, {0.5, 0}, {0.5, 0.25}, {0.25, 0.125}, {0, 0.25}});
  const double area = ring_area(points);
  for (Vec3d& p : points) p += Vec3d{1e6, 6e6, 100};
  check_cut(points, {}, area);
}

TEST_CASE("random star polygons with star holes keep their area") {
  CHECK(rc::check([] {
    std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
    auto points = star(random, *rc::gen::inRange<std::size_t>(4, 200), 0, 0, 50);
    double area = ring_area(points);
    std::vector<std::uint32_t> holes;
    const int hole_count = *rc::gen::inRange(0, 6);
    for (int h = 0; h < hole_count; ++h) {
      // Inside every star of radius 50 there is a disc of radius 10 less a little.
      const double angle = h * kPi / 3;
      const auto hole = star(random, *rc::gen::inRange<std::size_t>(4, 40), 4 * std::cos(angle),
                             4 * std::sin(angle), 1.5);
      if (points.size() < 40) break;  // with few corners the disc is smaller
      area -= ring_area(hole);
      holes.push_back(static_cast<std::uint32_t>(points.size()));
      points.insert(points.end(), hole.begin(), hole.end());
    }
    const PolygonTriangles cut = triangulate_polygon(points, holes);
    RC_ASSERT(!cut.fanned);
    RC_ASSERT(cut.triangles.size() == points.size() - 2 + 2 * holes.size());
    double sum = 0;
    for (const auto& t : cut.triangles) {
      RC_ASSERT(signed_area(points, t) > -1e-12);
      sum += signed_area(points, t);
    }
    RC_ASSERT(std::abs(sum - area) < 1e-6 * area);
    RC_ASSERT(fits_together(cut, points.size()));
  }));
}

TEST_CASE("a polygon of ten thousand corners is cut exactly") {
  std::mt19937 random(3);
  const auto points = star(random, 10'000, 0, 0, 1);
  check_cut(points, {}, ring_area(points));
  // A comb of two thousand teeth: every gap is reflex, every tooth is far from its neighbours.
  std::vector<Vec3d> comb{tilted(4000, -1)};
  for (int i = 4000; i >= 0; --i) comb.push_back(tilted(i, i % 2 == 0 ? 100 : 1));
  comb.push_back(tilted(0, -1));
  check_cut(comb, {}, ring_area(comb));
}

}  // namespace crease
