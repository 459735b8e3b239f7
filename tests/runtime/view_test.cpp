// What a camera asks for: each criterion alone, as counts. A cut that obeys a view
// without hysteresis does not depend on the way there.
#include "crease/adaptive_mesh.h"
#include "pipeline/hierarchy_case.h"
#include "runtime/renderer_copy.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace crease {
namespace {

std::shared_ptr<const MeshHierarchy> hierarchy_of(Mesh mesh) {
  return std::make_shared<const MeshHierarchy>(simplified_case(std::move(mesh)).hierarchy);
}

// simplified_case() snaps to 20 bits around the grid's origin: `eye` is in longest sides.
ViewParameters view_from(const MeshHierarchy& h, const Vec3d& eye, double pixels = 1) {
  const double size = (1 << 20) * h.vertices.grid.step;
  ViewParameters view;
  view.camera.position = h.vertices.grid.origin + eye * size;
  view.camera.target = h.vertices.grid.origin;
  view.camera.up = {0.1, 0.2, 1};
  view.camera.width_px = 640, view.camera.height_px = 480;
  view.camera.pixels = pixels;
  return view;
}

// Straight down, and so but for rounding.
TEST_CASE("a camera that looks along its up sees the same whatever rounding made of that") {
  const auto h = hierarchy_of(torus(24, 48));
  ViewParameters down = view_from(*h, {0.5, 0.5, 1.5}, 0.3);
  const double size = (1 << 20) * h->vertices.grid.step;
  down.camera.target = down.camera.position - Vec3d{0, 0, size};
  down.camera.up = {0, 0, 1};
  down.camera.vertical_fov_deg = 25;
  AdaptiveMesh exact(h);
  exact.update(down);
  for (const Vec3d& noise : {Vec3d{1e-9, 0, 0}, Vec3d{0, 1e-9, 0}, Vec3d{-1e-9, 3e-9, 0}}) {
    ViewParameters nearly = down;
    nearly.camera.target += noise * size;
    AdaptiveMesh mesh(h);
    mesh.update(nearly);
    CHECK(shown_triangles(mesh.draw_list()) == shown_triangles(exact.draw_list()));
  }
}

const Vec3d kNear{0.4, -1.6, 0.6};

std::size_t triangles_for(const std::shared_ptr<const MeshHierarchy>& h,
                          const ViewParameters& view) {
  AdaptiveMesh mesh(h);
  mesh.update(view);
  return mesh.triangle_count();
}

TEST_CASE("without hysteresis the cut of a view is the same whatever was seen before") {
  const auto check = [](const std::shared_ptr<const MeshHierarchy>& h) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    AdaptiveMesh wanderer(h);
    for (int i = 0; i < 12; ++i) {
      CAPTURE(i);
      ViewParameters view = view_from(*h, {2 * unit(random), 2 * unit(random), unit(random)});
      view.camera.pixels = i % 3 == 0 ? 1 : 0.3;
      view.hysteresis = 1;
      wanderer.update(view);
      AdaptiveMesh fresh(h);
      fresh.update(view);
      REQUIRE(shown_triangles(wanderer.draw_list()) == shown_triangles(fresh.draw_list()));
    }
  };
  check(hierarchy_of(torus(24, 48)));
  check(hierarchy_of(city_blocks(3, 2)));
  check(hierarchy_of(height_field(24)));
}

TEST_CASE("a camera that stands still costs nothing") {
  const auto h = hierarchy_of(torus(24, 48));
  AdaptiveMesh mesh(h);
  const ViewParameters view = view_from(*h, kNear);
  CHECK(mesh.update(view).splits > 0);
  const UpdateReport again = mesh.update(view);
  CHECK(again.splits + again.merges == 0);
  CHECK(again.evaluated == 0);
  CHECK(mesh.changes().positions.empty());
}

TEST_CASE("nearer cameras and fewer pixels of error need more triangles") {
  const auto h = hierarchy_of(torus(24, 48));
  const std::size_t near = triangles_for(h, view_from(*h, kNear));
  CHECK(near > triangles_for(h, view_from(*h, kNear * 8.0)));
  CHECK(near > triangles_for(h, view_from(*h, kNear, 8)));
  CHECK(near < triangles_for(h, view_from(*h, kNear, 0.25)));
}

TEST_CASE("degrees of shading are kept beside pixels") {
  const auto h = hierarchy_of(torus(24, 48));
  ViewParameters view = view_from(*h, kNear, 50);
  const std::size_t any = triangles_for(h, view);
  view.degrees = 6;
  const std::size_t rough = triangles_for(h, view);
  view.degrees = 1;
  CHECK(rough > any);
  CHECK(triangles_for(h, view) > rough);
}

TEST_CASE("what is outside the frustum stays coarse, unless it is asked for") {
  const auto h = hierarchy_of(height_field(24));
  ViewParameters view = view_from(*h, {0, -0.3, 0.2}, 0.5);
  view.camera.target = view.camera.position + Vec3d{0, -1, 0};  // away from it
  const std::size_t outside = triangles_for(h, view);
  view.coarse_outside = false;
  CHECK(triangles_for(h, view) > 2 * outside);
}

TEST_CASE("what faces away stays coarse only where that is asked for") {
  const auto h = hierarchy_of(smooth_sphere(24, 48));
  ViewParameters view = view_from(*h, kNear, 0.5);
  const std::size_t all = triangles_for(h, view);
  view.coarse_backfaces = true;
  CHECK(triangles_for(h, view) < all);
}

TEST_CASE("silhouettes are finer when they weigh more") {
  const auto h = hierarchy_of(smooth_sphere(24, 48));
  ViewParameters view = view_from(*h, kNear, 2);
  const std::size_t even = triangles_for(h, view);
  view.silhouette_weight = 4;
  CHECK(triangles_for(h, view) > even);
}

TEST_CASE("a budget of triangles is kept, and spent") {
  const auto h = hierarchy_of(torus(24, 48));
  ViewParameters view = view_from(*h, kNear, 0.1);
  REQUIRE(triangles_for(h, view) > 600);
  for (const bool consistent : {false, true}) {
    CAPTURE(consistent);
    view.consistent = consistent;
    AdaptiveMesh mesh(h);
    for (const std::size_t budget : {500, 200, 600, 60, 333, 123, 456}) {
      CAPTURE(budget);
      view.max_triangles = budget;
      mesh.update(view);
      CHECK(mesh.triangle_count() <= budget);
      CHECK(mesh.triangle_count() + 20 > budget);
    }
  }
}

// A clock that is a millisecond later at each look.
double ticking(void* context) {
  double& now = *static_cast<double*>(context);
  return now += 1e-3;
}

TEST_CASE("what time does not suffice for is done by the next updates") {
  const auto h = hierarchy_of(torus(24, 48));
  AdaptiveMesh at_once(h), by_and_by(h);
  ViewParameters view = view_from(*h, kNear, 0.2);
  at_once.update(view);
  double now = 0;
  view.max_seconds = 2e-3;
  view.clock = ticking;
  view.clock_context = &now;
  int updates = 1;
  for (; !by_and_by.update(view).complete && updates < 10'000; ++updates) {
    REQUIRE(by_and_by.triangle_count() <= at_once.triangle_count());
  }
  CHECK(updates > 2);
  CHECK(shown_triangles(by_and_by.draw_list()) == shown_triangles(at_once.draw_list()));
}

TEST_CASE("a view that is none changes nothing, and one from beyond all floats is forgotten") {
  const auto h = hierarchy_of(torus(24, 48));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const ViewParameters good = view_from(*h, kNear, 0.5);
  const auto with = [&good](auto change) {
    ViewParameters view = good;
    change(view.camera);
    return view;
  };
  AdaptiveMesh mesh(h);
  mesh.update(good);
  const auto shown = shown_triangles(mesh.draw_list());
  for (const ViewParameters& none :
       {with([&](Camera& c) { c.position.x = nan; }), with([&](Camera& c) { c.position.y = inf; }),
        with([&](Camera& c) { c.target = c.position; }), with([&](Camera& c) { c.height_px = 0; }),
        with([&](Camera& c) { c.vertical_fov_deg = nan; }),
        with([&](Camera& c) { c.pixels = nan; }), with([&](Camera& c) { c.up = {}; })}) {
    const UpdateReport report = mesh.update(none, nan);
    CHECK(report.splits + report.merges == 0);
    CHECK(shown_triangles(mesh.draw_list()) == shown);
  }
  for (const double far : {1e12, 1e16, 1e18, 1e20, 1e30, 1e100, 1e300}) {
    CAPTURE(far);
    mesh.update(with([&](Camera& c) { c.position = {far, 0, 0}; }));
    mesh.update(good);
    CHECK(shown_triangles(mesh.draw_list()) == shown);
    mesh.update(with([&](Camera& c) { c.target = {0, far, far}; }));
    mesh.update(good);
    CHECK(shown_triangles(mesh.draw_list()) == shown);
  }
}

TEST_CASE("seconds that are no number let nothing be on its way for good") {
  const auto h = hierarchy_of(torus(24, 48));
  AdaptiveMesh mesh(h);
  mesh.set_geomorph_seconds(0.25);
  const ViewParameters view = view_from(*h, kNear, 0.5);
  mesh.update(view, std::numeric_limits<double>::quiet_NaN());
  mesh.update(view, -1);
  UpdateReport report;
  for (int i = 0; i < 20; ++i) report = mesh.update(view, 0.05);
  CHECK(report.moving == 0);
  for (const Vec3f& p : mesh.draw_list().positions) REQUIRE(std::isfinite(p.x + p.y + p.z));
}

TEST_CASE("hysteresis lets a camera that wavers change nothing") {
  const auto h = hierarchy_of(torus(24, 48));
  AdaptiveMesh mesh(h);
  const ViewParameters here = view_from(*h, kNear), there = view_from(*h, kNear * 1.02);
  mesh.update(there);
  mesh.update(here);
  mesh.update(there);
  std::size_t moves = 0;
  for (int i = 0; i < 6; ++i) {
    const UpdateReport report = mesh.update(i % 2 == 0 ? here : there);
    moves += report.splits + report.merges;
  }
  CHECK(moves == 0);
}

TEST_CASE("consistent refinement splits third vertices first, so it needs no fewer triangles") {
  const auto h = hierarchy_of(torus(24, 48));
  ViewParameters view = view_from(*h, {0.2, -0.5, 0.1}, 0.5);
  const std::size_t free = triangles_for(h, view);
  view.consistent = true;
  CHECK(triangles_for(h, view) >= free);
}

}  // namespace
}  // namespace crease
