#include "measure/furthest.h"

#include "crease/compare.h"
#include "measure/closest_point.h"
#include "measure/mesh_pairs.h"
#include "measure/same_triangles.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace crease;

namespace {

constexpr double kRelative = 0.01, kAbsolute = 1e-9;
constexpr std::size_t kPlenty = 1'000'000;

// By a grid of points on each triangle: `found` is far, and no point is further than `bound`.
struct Dense {
  double found = 0, bound = 0;
};

bool has_area(const Surface& surface, std::size_t t) {
  const Vec3d a = surface.corner(t, 0), ab = surface.corner(t, 1) - a,
              ac = surface.corner(t, 2) - a;
  return length(cross(ab, ac)) > kAbsolute * std::max({length(ab), length(ac), length(ac - ab)});
}

// What has no area is no surface, unless nothing has.
Dense furthest_of_grids(const Surface& from, const Surface& to, int n) {
  Dense dense;
  Surface::Scratch scratch;
  bool any = false;
  for (std::size_t t = 0; t < from.triangle_count(); ++t) any |= has_area(from, t);
  for (std::size_t t = 0; t < from.triangle_count(); ++t) {
    if (any && !has_area(from, t)) continue;
    const Vec3d a = from.corner(t, 0), ab = from.corner(t, 1) - a, ac = from.corner(t, 2) - a;
    // Each point of the triangle is in a small one, whose corners are of the grid.
    const double spacing = std::max({length(ab), length(ac), length(ac - ab)}) / n;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        const Vec3d p = a + ab * (double(i) / n) + ac * (double(j) / n);
        const double distance = to.nearest(p, nullptr, 0, scratch).distance;
        dense.found = std::max(dense.found, distance);
        dense.bound = std::max(dense.bound, distance + spacing / std::sqrt(3.0));
      }
    }
  }
  return dense;
}

Furthest furthest(const Surface& from, const Surface& to, FurthestOptions options = {}) {
  if (options.max_queries == 0) options.max_queries = kPlenty;
  options.relative = kRelative;
  options.absolute = kAbsolute;
  const ProgressCallback nobody;
  SharedProgress progress(nobody, "furthest", 1);
  return find_furthest(from, to, options, progress);
}

void check_against_grids(const Mesh& from, const Mesh& to, int n) {
  const Frame frame = common_frame(from, to);
  const Surface a(from, frame), b(to, frame);
  const Dense dense = furthest_of_grids(a, b, n);
  const Furthest found = furthest(a, b);
  CHECK(found.queries < kPlenty);
  CHECK(found.distance <= dense.bound);
  CHECK(found.bound >= dense.found);
  CHECK(found.bound ==
        doctest::Approx(found.distance * (1 + kRelative) + kAbsolute).epsilon(1e-12));
}

// So that no number is round.
Mesh turned(Mesh mesh) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3d& p : mesh.positions) {
    p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  }
  return mesh;
}

Mesh wall(int cells) {
  MeshBuilder b;
  b.grid({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells, cells);
  return b.take();
}

//  +--+--+--+
//  |  |  |  |    One cell of cells^2 is open, none of the border.
//  +--+--+--+
//  |  |  |##|
Mesh wall_with_window(int cells, int column, int row) {
  Mesh mesh = wall(cells);
  const Vec3d low{double(column) / cells, double(row) / cells, 0};
  std::vector<Triangle> kept;
  std::vector<AttributeId> normals;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Vec3d middle;
    for (VertexId v : mesh.triangles[t]) middle += mesh.positions[index_of(v)] * (1.0 / 3);
    const Vec3d inside = (middle - low) * cells;
    if (inside.x > 0 && inside.x < 1 && inside.y > 0 && inside.y < 1) continue;
    kept.push_back(mesh.triangles[t]);
    for (std::size_t c = 0; c < 3; ++c) {
      normals.push_back(mesh.normals()->of_corner[3 * t + c]);
    }
  }
  mesh.triangles = kept;
  mesh.normals()->of_corner = normals;
  return mesh;
}

}  // namespace

TEST_CASE("the furthest point is that of dense grids, zoo mesh against zoo mesh") {
  for_zoo_pairs([](const Mesh& a, const Mesh& b) {
    check_against_grids(a, b, 12);
    check_against_grids(b, a, 12);
    check_against_grids(a, moved(a, {1e-2, 2e-2, -1e-2}), 12);
  });
}

TEST_CASE("the furthest point is that of dense grids on random triangles") {
  CHECK(rc::check([] { check_against_grids(any_triangles(), any_triangles(), 16); }));
}

TEST_CASE("a covered window is found whatever the samples are") {
  const Mesh whole = wall(1);
  for (int cells : {32, kSanitized ? 101 : 317}) {
    const Mesh open = wall_with_window(cells, cells / 3, cells / 2);
    const double half = 0.5 / cells;  // from the middle of the window to its frame
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(cells);
      CAPTURE(seed);
      const Comparison c = *compare_meshes(open, whole, {.samples = 100, .seed = seed});
      CHECK(c.distance.a_to_b.max < 1e-12);
      CHECK(c.distance.b_to_a.max <= half * (1 + 1e-9));
      CHECK(c.distance.b_to_a.max >= half / (1 + kMaxTolerance) - 1e-8);
      CHECK(c.distance.b_to_a.bound >= half);
    }
    CHECK(*meshes_within(open, whole, half * 1.001, {}));
    CHECK(!*meshes_within(open, whole, half * 0.999, {}));
    CHECK(!*meshes_within(whole, open, half * 0.999, {}));
    const Result<bool> no_number = meshes_within(whole, open, std::nan(""), {});
    REQUIRE(!no_number.ok());
    CHECK(no_number.failure().error == Error::BadValue);
  }
}

TEST_CASE("a needle without area is no surface, unless there is nothing else") {
  const Mesh plain = turned(wall(4));
  Mesh with_needle = plain;
  const Vec3d top = plain.positions[0] + Vec3d{3, 4, 5};
  with_needle.positions.push_back(plain.positions[0]);
  with_needle.positions.push_back(top);
  with_needle.triangles.push_back(
      {VertexId{0}, VertexId(plain.positions.size()), VertexId(plain.positions.size() + 1)});
  AttributeLayer& normals = *with_needle.normals();
  normals.of_corner.insert(normals.of_corner.end(), 3, AttributeId{0});
  const Comparison c = *compare_meshes(with_needle, plain, {.samples = 1000});
  CHECK(c.distance.a_to_b.max < 1e-12);
  CHECK(*meshes_within(with_needle, plain, 0, {}));

  Mesh needle = with_needle;
  needle.triangles = {with_needle.triangles.back()};
  needle.normals()->of_corner.assign(3, AttributeId{0});
  CHECK(compare_meshes(needle, plain, {.samples = 1000})->distance.a_to_b.max > 1);
}

TEST_CASE("walls that are cut into other triangles are one wall, and that is soon found") {
  const std::pair<Mesh, Mesh> same[] = {{turned(wall(3)), turned(wall(7))},
                                        {turned(hard_box(3)), turned(hard_box(7))},
                                        {turned(wall(1)), turned(wall(40))}};
  for (const auto& [one, two] : same) {
    const Frame frame = common_frame(one, two);
    const Surface a(one, frame), b(two, frame);
    for (const Furthest& found : {furthest(a, b), furthest(b, a)}) {
      CHECK(found.distance < 1e-12);
      CHECK(found.bound < 1.1e-9);
      CHECK(found.queries < 20 * (one.triangle_count() + two.triangle_count()));
    }
    CHECK(*meshes_within(one, two, 0, {}));
  }
}

TEST_CASE("surfaces that are equally far apart all over take a bounded time") {
  const Mesh inner = smooth_sphere(64, 128);
  for (double scale : {1.001, 1.25, 4.0}) {
    CAPTURE(scale);
    const Mesh outer = moved(smooth_sphere(60, 100), {}, scale);
    const Frame frame = common_frame(inner, outer);
    const Surface a(inner, frame), b(outer, frame);
    CHECK(furthest(a, b).queries < 32 * inner.triangle_count());
    CHECK(furthest(b, a).queries < 32 * inner.triangle_count());
  }
}

TEST_CASE("what was not looked at for want of queries is in the bound") {
  const Mesh open = wall_with_window(100, 30, 60), whole = wall(1);
  const Frame frame = common_frame(open, whole);
  const Surface a(whole, frame), b(open, frame);
  const double half = 0.005 * frame.scale;
  double last = 1e9;
  for (std::size_t queries : {1, 100, 1000, 10'000}) {
    const Furthest found = furthest(a, b, {.max_queries = queries});
    CHECK(found.queries < queries + 100'000);
    CHECK(found.distance <= half * (1 + 1e-9));
    CHECK(found.bound >= half);
    CHECK(found.bound <= last);
    last = found.bound;
  }
  CHECK(furthest(a, b, {.max_queries = 1}).bound > 2 * half);
}

TEST_CASE("the furthest distance is the same for any number of threads, and for any samples" *
          doctest::test_suite("threads")) {
  const Mesh a = turned(torus(48, 24)), b = turned(torus(20, 9));
  const Comparison one = *compare_meshes(a, b, {.samples = 2000, .threads = 1});
  for (int threads : {2, 7}) {
    const Comparison c = *compare_meshes(a, b, {.samples = 2000, .threads = threads});
    CHECK(c.distance.a_to_b.max == one.distance.a_to_b.max);
    CHECK(c.distance.b_to_a.max == one.distance.b_to_a.max);
    CHECK(c.distance.a_to_b.bound == one.distance.a_to_b.bound);
    CHECK(c.distance.b_to_a.bound == one.distance.b_to_a.bound);
  }
  const Comparison other = *compare_meshes(a, b, {.samples = 1, .seed = 5});
  CHECK(other.distance.b_to_a.max == doctest::Approx(one.distance.b_to_a.max).epsilon(0.01));
}

TEST_CASE("meshes are within what they are apart and not within less") {
  const std::pair<Mesh, Mesh> pairs[] = {{torus(48, 24), torus(20, 9)},
                                         {smooth_sphere(16, 32), smooth_sphere(8, 12)},
                                         {gear(40), gear(20)}};
  for (const auto& [a, b] : pairs) {
    const Comparison c = *compare_meshes(a, b, {.samples = 1000});
    const double apart = std::max(c.distance.a_to_b.max, c.distance.b_to_a.max);
    const double bound = std::max(c.distance.a_to_b.bound, c.distance.b_to_a.bound);
    for (int threads : {1, 2, 7}) {
      CHECK(*meshes_within(a, b, bound, {.threads = threads}));
      CHECK(!*meshes_within(a, b, apart * 0.999, {.threads = threads}));
    }
    CHECK(*meshes_within(a, a, 0, {}));
  }
  // All over at the limit.
  CHECK(*meshes_within(wall(3), moved(wall(5), {0, 0, 0.25}), 0.25, {}));
}

TEST_CASE("the search for meshes within a distance stops where its caller asks it to") {
  const Result<bool> within = meshes_within(
      hard_box(3), hard_box(7), 0.1, {.progress = [](const char*, double) { return false; }});
  REQUIRE(!within.ok());
  CHECK(within.failure().error == Error::Interrupted);
}

TEST_CASE("a triangle is the same whichever corner comes first, and not if it is elsewhere") {
  Mesh other = wall(4);
  for (Triangle& t : other.triangles) t = {t[1], t[2], t[0]};
  std::swap(other.triangles[3], other.triangles[7]);
  const Mesh mesh = wall(4);
  const SameTriangles same(mesh);
  for (std::size_t t = 0; t < other.triangle_count(); ++t) CHECK(same.has(other, t));
  const VertexId v = other.triangles[5][2];
  other.positions[index_of(v)].z = 0x1p-60;
  for (std::size_t t = 0; t < other.triangle_count(); ++t) {
    const Triangle& triangle = other.triangles[t];
    CHECK(same.has(other, t) == (std::ranges::find(triangle, v) == triangle.end()));
  }
}
