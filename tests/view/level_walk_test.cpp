// A linear mesh that moves step by step arrives where it would in one.
#include "view/level_walk.h"

#include "crease/build_progressive_arrays.h"
#include "crease/decode_model.h"
#include "support/mesh_zoo.h"
#include "view/streamed_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace crease {

TEST_CASE(
    "a walk arrives at the level that was asked for, in steps between which it can be drawn") {
  const StreamedModel model = streamed_model(smooth_sphere(130, 260), 8000);
  const Result<BlockFile> file = BlockFile::open(memory_source(model.bytes));
  REQUIRE(file.ok());
  const Result<DecodedModel> decoded = decode_model(*file);
  REQUIRE(decoded.ok());
  const ProgressiveArraysPtr arrays = build_progressive_arrays(decoded->mesh, decoded->sequence);
  ProgressiveMesh walked(arrays), direct(arrays);
  REQUIRE(walked.contraction_count() > 30'000);
  LevelWalk walk;
  std::mt19937 random(3);
  std::size_t longest = 0;
  for (int i = 0; i < 60; ++i) {
    LevelGoal goal;
    goal.error = i % 7 == 0 ? 0 : std::pow(10.0f, -float(random() % 60) / 10);
    goal.max_triangles = i % 3 == 0 ? random() % 70'000 : std::size_t(100'000);
    std::size_t frames = 0;
    const auto changes = [&] { CHECK(walked.draw_list().sn.triangle_count() > 0); };
    while (!walk.go(walked, goal, 0, changes)) REQUIRE(++frames < 100);
    longest = std::max(longest, frames);
    direct.set_applied(direct.applied_for_view(goal.error));
    if (direct.triangle_count() > goal.max_triangles) direct.set_triangle_count(goal.max_triangles);
    CHECK(walked.triangle_count() == direct.triangle_count());
    CHECK(walked.applied() == direct.applied());
    const auto nothing = [] { FAIL("it is there already"); };
    CHECK(walk.go(walked, goal, 0, nothing));
  }
  CHECK(longest >= 3);
}

}  // namespace crease
