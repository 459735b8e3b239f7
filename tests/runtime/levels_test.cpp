#include "crease/build_progressive_arrays.h"
#include "crease/progressive_mesh.h"
#include "support/level_equality.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace crease {
namespace {

TEST_CASE("a triangle count gives the finest level with at most that many") {
  const Case c = make_case(hard_cylinder(24, 4), {.seed = 8});
  ProgressiveMesh pm(c.arrays);
  std::vector<std::size_t> count_of_level;
  for (std::size_t n = 0; n <= pm.contraction_count(); ++n) {
    pm.set_applied(n);
    count_of_level.push_back(pm.triangle_count());
  }
  CHECK(pm.base_triangle_count() == count_of_level.back());
  CHECK(pm.full_triangle_count() == c.mesh.triangle_count());
  for (std::size_t asked = c.mesh.triangle_count() + 5; asked-- > 0;) {
    std::size_t expected = 0;
    while (expected < pm.contraction_count() && count_of_level[expected] > asked) ++expected;
    for (std::size_t from : {std::size_t(0), pm.contraction_count(), asked % 50}) {
      pm.set_applied(from);
      pm.set_triangle_count(asked);
      CHECK(pm.applied() == expected);
    }
  }
}

TEST_CASE("an error gives the coarsest level that keeps it, and error() is the largest so far") {
  const Case c = make_case(height_field(8), {.seed = 6});
  ProgressiveMesh pm(c.arrays);
  const std::vector<Contraction>& contractions = c.sequence.contractions;
  LevelError worst;
  std::vector<float> error_of_level{0};
  for (std::size_t n = 1; n <= contractions.size(); ++n) {
    const LevelError& e = contractions[n - 1].error;
    worst = {std::max(worst.surface, e.surface), std::max(worst.line, e.line),
             std::max(worst.degrees, e.degrees), std::max(worst.texture, e.texture)};
    pm.set_applied(n);
    CHECK(pm.error().surface == worst.surface);
    CHECK(pm.error().line == worst.line);
    CHECK(pm.error().degrees == worst.degrees);
    CHECK(pm.error().texture == worst.texture);
    error_of_level.push_back(worst.surface);
  }
  const float most = worst.surface;
  for (float asked :
       {0.0f, 0.1f * most, 0.5f * most, most, 2 * most, std::numeric_limits<float>::infinity()}) {
    std::size_t expected = contractions.size();
    while (error_of_level[expected] > asked) --expected;
    pm.set_error(asked);
    CHECK(pm.applied() == expected);
    CHECK(pm.error().surface <= asked);
  }
  pm.set_error(-1);
  CHECK(pm.applied() <= contractions.size());
  pm.set_error(std::nanf(""));
  CHECK(pm.applied() == 0);
}

TEST_CASE("the empty mesh has one level") {
  Mesh mesh;
  mesh.layers.push_back({.name = "normal",
                         .role = AttributeRole::Normal,
                         .interpolation = Interpolation::Direction,
                         .dimension = 3,
                         .values = {},
                         .of_corner = {}});
  ProgressiveMesh pm(build_progressive_arrays(mesh, ContractionSequence{}));
  pm.set_triangle_count(10);
  pm.set_error(1);
  CHECK(pm.applied() == 0);
  CHECK(pm.extract().triangle_count() == 0);
}

}  // namespace
}  // namespace crease
