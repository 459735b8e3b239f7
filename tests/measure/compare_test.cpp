#include "crease/compare.h"

#include "measure/closest_point.h"
#include "measure/mesh_pairs.h"
#include "measure/sample.h"
#include "measure/surface.h"
#include "measure/triangle_pieces.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>

using namespace crease;

namespace {

// What nearest() must give, triangle by triangle.
Nearest nearest_by_brute_force(const Surface& surface, const Vec3d& p, const Vec3d& normal,
                               double tie) {
  std::vector<ClosestPoint> found;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    found.push_back(
        closest_point(p, surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2)));
    best = std::min(best, std::sqrt(found.back().squared_distance));
  }
  double deviation = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
    if (std::sqrt(found[t].squared_distance) > best + tie) continue;
    deviation = std::min(deviation, angle_between(normal, surface.normal(t, found[t].weights)));
  }
  return {best, deviation};
}

void check_against_brute_force(const Mesh& a, const Mesh& b, std::size_t samples) {
  const Frame frame = common_frame(a, b);
  const Surface surface_a(a, frame), surface_b(b, frame);
  const Sampler sampler(surface_a, samples, 7);
  const double tie = 1e-5 * frame.size * frame.scale;
  Surface::Scratch scratch;
  for (std::size_t i = 0; i < samples; ++i) {
    const SurfacePoint s = sampler(i);
    Vec3d p;
    for (std::size_t c = 0; c < 3; ++c) p += surface_a.corner(s.triangle, c) * s.weights[c];
    const Vec3d normal = surface_a.normal(s.triangle, s.weights);
    const Nearest expected = nearest_by_brute_force(surface_b, p, normal, tie);
    const Nearest got = surface_b.nearest(p, &normal, tie, scratch);
    CHECK(got.distance == expected.distance);
    CHECK(got.deviation_rad == expected.deviation_rad);
  }
}

// Cables across a cube: prisms of three long thin sides, none along an axis.
Mesh cables(std::uint32_t count, double width, double shift) {
  MeshBuilder b;
  std::mt19937 random(3);
  const auto any = [&random] { return double(random()) / double(std::mt19937::max()); };
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3d from{any(), any(), 0.1 * any()}, to{any(), any(), 0.9 + 0.1 * any()};
    VertexId ring[2][3];
    for (std::size_t k = 0; k < 3; ++k) {
      const double angle = 2.1 * double(k) + shift;
      const Vec3d out = Vec3d{std::cos(angle), std::sin(angle), 0} * width;
      ring[0][k] = b.vertex(from + out);
      ring[1][k] = b.vertex(to + out);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      b.flat_triangle({ring[0][k], ring[0][(k + 1) % 3], ring[1][k]});
      b.flat_triangle({ring[1][k], ring[0][(k + 1) % 3], ring[1][(k + 1) % 3]});
    }
  }
  return b.take();
}

Mesh square(double z, int cells) {
  MeshBuilder b;
  b.grid({0, 0, z}, {1, 0, 0}, {0, 1, 0}, cells, cells);
  return b.take();
}

bool same(const Comparison& a, const Comparison& b) {
  const auto same_spread = [](const Spread& x, const Spread& y) {
    return x.mean == y.mean && x.rms == y.rms && x.max == y.max;
  };
  return same_spread(a.distance.a_to_b, b.distance.a_to_b) &&
         same_spread(a.distance.b_to_a, b.distance.b_to_a) &&
         a.normal_deviation.mean == b.normal_deviation.mean &&
         a.normal_deviation.p95 == b.normal_deviation.p95 &&
         a.normal_deviation.max == b.normal_deviation.max;
}

}  // namespace

TEST_CASE("long thin triangles are looked for in pieces, which have all of them") {
  for (const double width : {0.01, 1e-4, 0.0}) {
    CAPTURE(width);
    check_against_brute_force(cables(60, 0.01, 0.5), cables(60, width, 0), 2000);
  }
  std::mt19937 random(4);
  const auto any = [&random] { return double(random()) / double(std::mt19937::max()); };
  for (int i = 0; i < 300; ++i) {
    const Vec3d a{any(), any(), any()}, b{any(), any(), any()};
    const double thin = std::pow(10.0, -6 * any());
    const TriangleCorners corners{a, b, a + (b - a) * any() + Vec3d{any(), any(), any()} * thin};
    const auto pieces = pieces_of(1, [&](std::size_t) { return corners; });
    for (int k = 0; k < 50; ++k) {
      double u = any(), v = any();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d p = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
      const bool is_in_one = std::ranges::any_of(pieces, [&](const TrianglePiece& piece) {
        const PieceOutline outline = outline_of(corners, piece);
        for (int axis = 0; axis < 3; ++axis) {
          double low = 9, high = -9;
          for (std::size_t j = 0; j < outline.count; ++j) {
            low = std::min(low, outline.points[j][axis]);
            high = std::max(high, outline.points[j][axis]);
          }
          if (p[axis] < low - 1e-12 || p[axis] > high + 1e-12) return false;
        }
        return true;
      });
      CHECK((pieces.empty() || is_in_one));
    }
  }
  CHECK(pieces_of(2, [](std::size_t) {
          return TriangleCorners{Vec3d{0, 0, 0}, Vec3d{1, 0.5, 0.2}, Vec3d{0.2, 1, 0.7}};
        }).empty());
}

TEST_CASE("every mesh of the zoo is where it is") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() == 0) continue;
    CAPTURE(z.name);
    const Comparison c = *compare_meshes(z.mesh, z.mesh, {.samples = 2000});
    CHECK(c.distance.a_to_b.max < 1e-12 * c.diagonal);
    CHECK(c.distance.b_to_a.max < 1e-12 * c.diagonal);
    CHECK(c.normal_deviation.max < 1e-5);
  }
}

TEST_CASE("closest points equal the brute force, zoo mesh against zoo mesh") {
  for_zoo_pairs([](const Mesh& a, const Mesh& b) {
    check_against_brute_force(a, b, 100);
    check_against_brute_force(b, moved(a, {1e-4, 2e-4, -1e-4}), 100);
  });
}

TEST_CASE("closest points equal the brute force on random triangles") {
  CHECK(rc::check([] { check_against_brute_force(any_triangles(), any_triangles(), 20); }));
}

TEST_CASE("parallel squares are as far apart as they are") {
  for (double gap : {1e-8, 1e-3, 0.5}) {
    CAPTURE(gap);
    const Comparison c = *compare_meshes(square(0, 1), square(gap, 7), {.samples = 1000});
    for (const Spread& s : {c.distance.a_to_b, c.distance.b_to_a}) {
      CHECK(s.mean == doctest::Approx(gap).epsilon(1e-9));
      CHECK(s.rms == doctest::Approx(gap).epsilon(1e-9));
      CHECK(s.max == doctest::Approx(gap).epsilon(1e-9));
    }
    CHECK(c.normal_deviation.max < 1e-9);
    CHECK(c.diagonal == doctest::Approx(std::sqrt(2.0)));
  }
}

TEST_CASE("concentric spheres are their radii's difference apart") {
  const Mesh inner = smooth_sphere(64, 128), outer = moved(inner, {}, 1.25);
  const Comparison c = *compare_meshes(inner, outer, {.samples = 20'000});
  CHECK(c.distance.a_to_b.mean == doctest::Approx(0.25).epsilon(0.002));
  CHECK(c.distance.b_to_a.mean == doctest::Approx(0.25).epsilon(0.002));
  CHECK(c.distance.a_to_b.max < 0.2505);
  CHECK(c.normal_deviation.mean < 0.25);
}

TEST_CASE("the two directions differ when one mesh has a part more") {
  MeshBuilder b;
  b.box({0, 0, 0}, {1, 1, 1}, 1);
  b.box({3, 0, 0}, {4, 1, 1}, 1);
  const Mesh one = hard_box(1), two = b.take();
  const Comparison c = *compare_meshes(one, two, {.samples = 10'000});
  CHECK(c.distance.a_to_b.max < 1e-12);
  CHECK(c.distance.b_to_a.max == doctest::Approx(3));  // a vertex: samples alone stop short of it
  CHECK(c.distance.b_to_a.mean == doctest::Approx(1.25).epsilon(0.02));
}

TEST_CASE("normals that are turned are seen, all of them by their angle") {
  Mesh turned = hard_box(2);
  AttributeLayer& normals = *turned.normals();
  for (std::size_t n = 0; n < normals.value_count(); ++n) {
    float* v = &normals.values[3 * n];
    // By 10 degrees about an axis across it.
    const Vec3d from{v[0], v[1], v[2]}, across{v[1], v[2], v[0]};
    const Vec3d to = from * std::cos(radians(10.0)) + across * std::sin(radians(10.0));
    for (int i = 0; i < 3; ++i) v[i] = float(to[i]);
  }
  const Comparison c = *compare_meshes(hard_box(2), turned, {.samples = 10'000});
  CHECK(c.normal_deviation.mean == doctest::Approx(10).epsilon(1e-4));
  CHECK(c.normal_deviation.p95 == doctest::Approx(10).epsilon(1e-4));
  CHECK(c.normal_deviation.max == doctest::Approx(10).epsilon(1e-4));
}

TEST_CASE("turned normals of one side in six count for a sixth") {
  Mesh turned = hard_box(2);
  float* first = turned.normals()->values.data();
  std::swap(first[0], first[1]);  // by 90 degrees
  const Comparison c = *compare_meshes(hard_box(2), turned, {.samples = 10'000});
  CHECK(c.normal_deviation.mean == doctest::Approx(15).epsilon(0.01));
  CHECK(c.normal_deviation.max == doctest::Approx(90));
}

TEST_CASE("a sample on a hard edge sees the side that agrees") {
  // The same box in other cells: samples near edges find both sides.
  const Comparison c = *compare_meshes(hard_box(3), hard_box(7), {.samples = 50'000});
  CHECK(c.normal_deviation.max < 1e-5);
}

TEST_CASE("an offset of a thousand kilometres loses nothing") {
  // Multiples of 2^-20 m, so that the offset itself rounds nothing.
  Mesh mesh = torus(24, 12);
  for (Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) p[i] = std::round(p[i] * 0x1p20) * 0x1p-20;
  }
  const Mesh other = moved(mesh, {0x1p-12, 0, 0});
  const Vec3d offset{1e6, 5e6, 0};
  const Comparison near = *compare_meshes(mesh, other, {.samples = 5000});
  const Comparison far =
      *compare_meshes(moved(mesh, offset), moved(other, offset), {.samples = 5000});
  CHECK(same(near, far));
  CHECK(near.distance.a_to_b.mean > 0);
}

Mesh with_stray(Mesh mesh, const Vec3d& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
  AttributeLayer& normals = mesh.layers[0];
  const AttributeId id = normals.of_corner[0];
  for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{0.1, 0, 0}, Vec3d{0, 0.1, 0}}) {
    mesh.positions.push_back(at + p);
    normals.of_corner.push_back(id);
  }
  mesh.triangles.push_back({VertexId{first}, VertexId{first + 1}, VertexId{first + 2}});
  return mesh;
}

TEST_CASE("a stray triangle, however far away, changes little of what is said of the others") {
  const Mesh a = faceted_sphere(16, 32), b = faceted_sphere(20, 40);
  const Comparison alone = *compare_meshes(a, b, {.samples = 20'000});
  for (const double away : {1e3, 1e7}) {
    CAPTURE(away);
    const Vec3d at{away, -0.3 * away, 0};
    const Mesh far_a = with_stray(a, at), far_b = with_stray(b, at);
    const Comparison c = *compare_meshes(far_a, far_b, {.samples = 20'000});
    CHECK(c.distance.a_to_b.mean == doctest::Approx(alone.distance.a_to_b.mean).epsilon(0.02));
    CHECK(c.normal_deviation.mean == doctest::Approx(alone.normal_deviation.mean).epsilon(0.02));
    CHECK(c.distance.a_to_b.max < 0.1);
    check_against_brute_force(far_a, far_b, 200);
    check_against_brute_force(with_stray(a, at * 0.999), far_b, 200);
    check_against_brute_force(far_a, b, 200);
    // Nobody else's distance is measured where only one has it.
    const Comparison one = *compare_meshes(b, far_a, {.samples = 20'000});
    CHECK(one.distance.b_to_a.max == doctest::Approx(length(at)).epsilon(0.01));
    CHECK(one.distance.a_to_b.max < 0.1);
  }
}

TEST_CASE("size does not matter") {
  const Mesh a = torus(24, 12), b = torus(12, 8);
  const Comparison one = *compare_meshes(a, b, {.samples = 2000});
  for (double scale : {0x1p-80, 0x1p80}) {
    const Comparison c =
        *compare_meshes(moved(a, {}, scale), moved(b, {}, scale), {.samples = 2000});
    CHECK(c.distance.a_to_b.mean / scale == one.distance.a_to_b.mean);
    CHECK(c.normal_deviation.mean == one.normal_deviation.mean);
  }
}

TEST_CASE(
    "what is a thousand times its size apart is refused, not looked at triangle by triangle") {
  const Mesh near = square(0, 4);
  const double size = std::sqrt(2.0);
  const Result<Comparison> apart = compare_meshes(near, moved(near, {0, 0, 1001 * size}), {});
  REQUIRE(!apart.ok());
  CHECK(apart.failure().error == Error::BadValue);
  CHECK(apart.failure().message.find("1001 times the size of the larger") != std::string::npos);
  // The larger of the two counts, and the gap, not the middles.
  const Mesh large = moved(near, {}, 1001);
  const auto beside = compare_meshes(near, moved(near, {0, 0, 999 * size}), {.samples = 10});
  REQUIRE(beside.ok());
  CHECK(beside->distance.a_to_b.max == doctest::Approx(999 * size));
  CHECK(compare_meshes(near, moved(large, {0, 0, 1001 * size}), {.samples = 10}).ok());
}

TEST_CASE("the number of threads changes nothing" * doctest::test_suite("threads")) {
  const Mesh a = torus(48, 24), b = torus(20, 9);
  const Comparison one = *compare_meshes(a, b, {.samples = 20'000, .threads = 1});
  for (int threads : {2, 7}) {
    CAPTURE(threads);
    CHECK(same(one, *compare_meshes(a, b, {.samples = 20'000, .threads = threads})));
  }
  CHECK(!same(one, *compare_meshes(a, b, {.samples = 20'000, .seed = 2})));
}

TEST_CASE("a comparison stops where its caller asks it to") {
  const Mesh a = hard_box(3), b = hard_box(7);
  for (const int threads : {1, 4}) {
    for (const int asked_after : {1, 3, 20}) {
      int told = 0;
      double last = 0;
      const Result<Comparison> c = compare_meshes(
          a, b,
          {.samples = 20'000, .threads = threads, .progress = [&](const char* stage, double done) {
             CHECK(std::string(stage) == "compare");
             CHECK(done > 0);
             CHECK(done <= 1);
             last = std::max(last, done);
             return ++told < asked_after;
           }});
      REQUIRE(!c.ok());
      CHECK(c.failure().error == Error::Interrupted);
      CHECK(told == asked_after);
      CHECK(last < 1);
    }
  }
}

TEST_CASE("progress changes nothing and ends at all") {
  const Mesh a = hard_box(3), b = hard_box(7);
  double last = 0;
  const Result<Comparison> c = compare_meshes(
      a, b, {.samples = 20'000, .threads = 1, .progress = [&](const char*, double done) {
               last = done;
               return true;
             }});
  REQUIRE(c.ok());
  CHECK(last == 1);
  CHECK(same(*c, *compare_meshes(a, b, {.samples = 20'000})));
}
