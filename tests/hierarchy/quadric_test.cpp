#include "hierarchy/quadric.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace crease;
using namespace crease::simplification;

TEST_CASE("a quadric is the sum of squared distances to its planes") {
  const Vec3d normals[] = {{1, 0, 0}, normalized(Vec3d{1, 2, -1}), normalized(Vec3d{0, 1, 3})};
  const double offsets[] = {-2, 0.5, 7}, weights[] = {1, 2.5, 0.25};
  Quadric q;
  for (int i = 0; i < 3; ++i) q.add_plane(normals[i], offsets[i], weights[i]);
  for (const Vec3d& x : {Vec3d{0, 0, 0}, Vec3d{1, -2, 5}, Vec3d{-3, 0.25, 11}}) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += weights[i] * std::pow(dot(normals[i], x) + offsets[i], 2);
    CHECK(q.at(x) == doctest::Approx(sum));
  }
  // Three planes meet in one point, and that is the minimum wherever the search starts.
  const Vec3d best = q.minimum({5, 5, 5}, 1e-12);
  CHECK(q.at(best) < 1e-12);
}

TEST_CASE("on a plane the minimum stays where it was looked for") {
  Quadric q;
  q.add_plane({0, 0, 1}, -3, 10);
  const Vec3d best = q.minimum({4, 5, 8}, 1e-4);
  CHECK(best.x == doctest::Approx(4));
  CHECK(best.y == doctest::Approx(5));
  CHECK(best.z == doctest::Approx(3).epsilon(1e-3));
}

// Of triangles with this weight on which the attribute is the linear function f.
AttributeQuadric of_linear(const Row& f, double weight) {
  AttributeQuadric quadric;
  quadric.own.weight = weight;
  quadric.own.add_square(f, weight);
  quadric.linear[0] = weight * f;
  return quadric;
}

TEST_CASE("the best value of a joined wedge is the least squares one") {
  // Two triangles whose attribute is x on the one and 2 - y on the other.
  const AttributeQuadric a = of_linear(Row{1, 0, 0, 0}, 1), b = of_linear(Row{0, -1, 0, 2}, 3);
  const Vec3d x{0.5, 0.25, 9};
  AttributeQuadric both = a;
  both.add(b, 1);
  const double best = (1 * x.x + 3 * (2 - x.y)) / 4;
  CHECK(both.weighted_value(0, x) / both.own.weight == doctest::Approx(best));
  const double error = std::pow(x.x - best, 2) + 3 * std::pow(2 - x.y - best, 2);
  const float rounded_best = static_cast<float>(best);
  CHECK(both.at(x, 1, &rounded_best) == doctest::Approx(error));
  Quadric reduced, pair;
  both.add_reduced(reduced, 1, 1);
  CHECK(reduced.at(x) == doctest::Approx(error));
  AttributeQuadric::add_reduced_pair(a, b, 1, pair, 1);
  CHECK(pair.at(x) == doctest::Approx(error));
}

TEST_CASE("an attribute that is the same all over its triangles is off by its difference") {
  const float red[] = {0.75f, 0.25f}, blue[] = {0.25f, 0.5f};
  AttributeQuadric constant;
  constant.add_constant(red, 3, 2);
  CHECK(constant.at({4, 5, 6}, 2, red) == doctest::Approx(0));
  CHECK(constant.at({4, 5, 6}, 2, blue) == doctest::Approx(3 * (0.5 * 0.5 + 0.25 * 0.25)));
  CHECK(constant.weighted_value(1, {4, 5, 6}) / constant.own.weight == doctest::Approx(0.25));
}
