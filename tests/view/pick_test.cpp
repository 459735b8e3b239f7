// What lies under the mouse.
#include "view/pick.h"

#include "crease/draw_list.h"
#include "support/mesh_zoo.h"
#include "view/streamed_model.h"
#include "view/two_part_city.h"

#include <doctest/doctest.h>

#include <cmath>

namespace crease {

namespace {

Camera camera_from(const Vec3d& position) {
  Camera camera;
  camera.position = position;
  camera.width_px = camera.height_px = 100;
  return camera;
}

}  // namespace

TEST_CASE("the ray to a sphere's middle meets its near side, and its normal faces the eye") {
  const MeshDrawArrays arrays(smooth_sphere(40, 80));
  const Camera camera = camera_from({3, 1, 2});
  const std::optional<Hit> hit = pick(arrays.draw_list(), ray_through(camera, 50, 50));
  REQUIRE(hit);
  const Vec3d expected = normalized(camera.position);
  CHECK(length(hit->position - expected) < 0.01);
  CHECK(hit->kind == TriangleKind::SN);
  CHECK(dot(Vec3d{hit->normal.x, hit->normal.y, hit->normal.z}, expected) > 0.999);
  for (const Vec3d& corner : hit->corners) CHECK(length(corner - hit->position) < 0.15);
  CHECK_FALSE(pick(arrays.draw_list(), ray_through(camera, 1, 1)));
}

TEST_CASE("a flat side is told with its one normal") {
  const MeshDrawArrays arrays(hard_box(1));
  Camera camera = camera_from({0.52, 0.51, 4});
  camera.target = {0.52, 0.51, 0};
  camera.up = {0, 1, 0};
  const std::optional<Hit> hit = pick(arrays.draw_list(), ray_through(camera, 50, 50));
  REQUIRE(hit);
  CHECK(hit->kind == TriangleKind::FN);
  CHECK(hit->normal.z == doctest::Approx(1));
  CHECK(hit->position.z == doctest::Approx(1));
}

TEST_CASE("of blocks the same is met as of all their triangles") {
  const StreamedModel model = streamed_model(smooth_sphere(32, 64), 400);
  BlockStreamer streamer = model.stream();
  BlockViewParameters parameters;
  parameters.in_levels = false;
  parameters.view.camera = camera_from({2, -1, 1});
  finish(streamer, parameters);
  const BlockMesh& mesh = streamer.mesh();
  REQUIRE(mesh.shown().size() > 1);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray = ray_through(parameters.view.camera, 100 * std::fmod(i * 0.618, 1.0), i / 2.0);
    std::optional<Hit> nearest;
    for (const ShownRange& range : mesh.shown()) {
      const auto hit = pick(range.block->draw_list(), {range.sn, range.fn, range.nsn}, ray);
      if (hit && (!nearest || hit->along < nearest->along)) nearest = hit;
    }
    const std::optional<Hit> hit = pick(mesh.shown(), mesh.facts().grid, ray);
    REQUIRE(hit.has_value() == nearest.has_value());
    if (!hit) continue;
    ++hits;
    CHECK(hit->along == nearest->along);
    REQUIRE(hit->block != nullptr);
  }
  CHECK(hits > 20);
}

TEST_CASE("a triangle of a block knows its part") {
  const Mesh mesh = two_part_city();
  const StreamedModel model = streamed_model(mesh, 8000);
  BlockStreamer streamer = model.stream();
  BlockViewParameters parameters;
  parameters.in_levels = false;
  parameters.view.camera = camera_from({20, 10, 30});
  parameters.view.camera.pixels = 1e-3;
  finish(streamer, parameters);
  while (streamer.mesh().part_names().empty()) {
    streamer.update(parameters);
    streamer.wait(std::chrono::milliseconds(20));
  }
  const auto check_parts = [&](const auto& shown) {
    int hits = 0;
    for (double x = model.low.x + 0.05; x < model.high.x; x += 0.13) {
      const Ray down{{x, (model.low.y + model.high.y) / 4 + model.low.y / 2, 100}, {0, 0, -1}};
      const std::optional<Hit> hit = pick(shown, streamer.mesh().facts().grid, down);
      if (!hit) continue;
      ++hits;
      CHECK(part_of(*hit, streamer.mesh()) == (hit->corners[0].x < 1.5 ? "left" : "right"));
    }
    CHECK(hits > 2);
  };
  check_parts(streamer.mesh().shown());
  parameters.by_vertex = true;
  finish(streamer, parameters);
  CHECK(streamer.mesh().shown().empty());
  check_parts(streamer.mesh().shown_cuts());
}

}  // namespace crease
