#include "measure/closest_point.h"

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>

using namespace crease;

namespace {

double distance(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return std::sqrt(closest_point(p, a, b, c).squared_distance);
}

}  // namespace

//   c        The seven regions: inside, three edges, three corners.
//   |\  .
//   a-b
TEST_CASE("the closest point of a triangle, region by region") {
  const Vec3d a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  CHECK(distance({0.25, 0.25, 2}, a, b, c) == doctest::Approx(2));
  CHECK(distance({0.5, -3, 0}, a, b, c) == doctest::Approx(3));
  CHECK(distance({-3, 0.5, 0}, a, b, c) == doctest::Approx(3));
  CHECK(distance({1, 1, 0}, a, b, c) == doctest::Approx(std::sqrt(0.5)));
  CHECK(distance({-3, -4, 0}, a, b, c) == doctest::Approx(5));
  CHECK(distance({4, -4, 0}, a, b, c) == doctest::Approx(5));
  CHECK(distance({-4, 4, 0}, a, b, c) == doctest::Approx(5));
}

TEST_CASE("triangles without area are segments or points") {
  CHECK(distance({0, 1, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}) == 1);
  CHECK(distance({1, 1, 0}, {0, 0, 0}, {0, 0, 0}, {2, 0, 0}) == 1);
  CHECK(distance({3, 1, 0}, {0, 0, 0}, {4, 0, 0}, {2, 0, 0}) == 1);
  CHECK(distance({3, 1, 0}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}) == 1);
}

TEST_CASE("a point on a sliver is on it") {
  for (double height : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    CAPTURE(height);
    const Vec3d a{0.1, 0.2, 0.3}, b{1.1, 0.7, 0.4};
    const Vec3d c = a * 0.3 + b * 0.7 + Vec3d{0, 0, height};
    for (double v : {0.0, 0.1, 0.5, 0.9}) {
      const Vec3d p = a * (0.9 - 0.9 * v) + b * (0.9 * v) + c * 0.1;
      for (const double far : {distance(p, a, b, c), distance(p, b, c, a), distance(p, c, a, b)}) {
        CHECK(far < 1e-9);
      }
    }
  }
}

TEST_CASE("no point of a random triangle is closer than the closest") {
  const auto coordinate = rc::gen::map(rc::gen::inRange(-8, 9), [](int i) { return i / 4.0; });
  const auto point = rc::gen::map(rc::gen::container<std::vector<double>>(3, coordinate),
                                  [](const std::vector<double>& x) {
                                    return Vec3d{x[0], x[1], x[2]};
                                  });
  CHECK(rc::check([&] {
    const Vec3d p = *point, a = *point, b = *point, c = *point;
    const ClosestPoint closest = closest_point(p, a, b, c);
    const auto& w = closest.weights;
    RC_ASSERT(w[0] >= -1e-12 && w[1] >= -1e-12 && w[2] >= -1e-12);
    const Vec3d q = a * w[0] + b * w[1] + c * w[2];
    RC_ASSERT(std::abs(length(p - q) - std::sqrt(closest.squared_distance)) < 1e-12);
    for (int i = 0; i <= 20; ++i) {
      for (int j = 0; i + j <= 20; ++j) {
        const Vec3d other = a * (i / 20.0) + b * (j / 20.0) + c * ((20 - i - j) / 20.0);
        RC_ASSERT(length(p - other) >= length(p - q) - 1e-12);
      }
    }
  }));
}
