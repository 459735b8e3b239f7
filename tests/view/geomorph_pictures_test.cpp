// With geomorphs no frame of a slow path differs from the one before as much as without.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "support/mesh_zoo.h"
#include "view/scene_picture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>

namespace crease {
namespace {

constexpr double kFrameSeconds = 1.0 / 60;
constexpr int kFrames = 60;
constexpr double kMost = 0.85;  // measured: 0.23 to 0.77

// How much of the picture a frame changes at the most: components of 255, mean of all pixels. Each
// is compared with what the mesh of the frame before shows to the same camera, so that the camera's
// own motion does not count.
double largest_jump(ScenePainter& painter, const std::shared_ptr<const MeshHierarchy>& hierarchy,
                    const Box& box, const std::function<ViewParameters(double)>& path,
                    double geomorph_seconds) {
  AdaptiveMesh mesh(hierarchy);
  mesh.update(path(0));
  mesh.set_geomorph_seconds(geomorph_seconds);
  GlScene scene(mesh.draw_list(), {}, nullptr, GL_DYNAMIC_DRAW);
  double largest = 0;
  for (int f = 0; f <= kFrames; ++f) {
    const ViewParameters view = path(double(f) / kFrames);
    const auto shown = [&] {
      return painter.paint(scene, view.camera, box, false, Coloring::Shaded);
    };
    const std::vector<std::uint8_t> before = shown();
    mesh.update(view, kFrameSeconds);
    scene.update(mesh.draw_list(), mesh.changes());
    const std::vector<std::uint8_t> after = shown();
    double sum = 0;
    for (std::size_t i = 0; i < after.size(); ++i) sum += std::abs(int(after[i]) - int(before[i]));
    largest = std::max(largest, sum / (kPicturePx * kPicturePx));
  }
  return largest;
}

ViewParameters view_at(double distance, double pixels) {
  ViewParameters view;
  view.camera = camera_at(0.7, distance);
  view.camera.pixels = pixels;
  return view;
}

// From 8 pixels of error to 1/2 and back.
ViewParameters slow_threshold(double share) {
  return view_at(3, std::exp2(3 - 4 * (1 - std::fabs(2 * share - 1))));
}

ViewParameters slow_zoom(double share) {
  return view_at(12 * std::exp2(-2 * share), 2);
}

}  // namespace

TEST_CASE("geomorphs keep pictures from jumping") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  ScenePainter painter(gl->limits());
  for (const Mesh& mesh : {smooth_sphere(24, 48), hard_cylinder(48, 12)}) {
    const Decoded all = decoded(mesh);
    Result<MeshHierarchy> built = build_hierarchy(all.model.mesh, all.model.sequence, {});
    REQUIRE(built.ok());
    const auto hierarchy = std::make_shared<const MeshHierarchy>(*std::move(built));
    for (const auto& path : {slow_threshold, slow_zoom}) {
      const double with = largest_jump(painter, hierarchy, all.box, path, 0.25);
      const double without = largest_jump(painter, hierarchy, all.box, path, 0);
      CAPTURE(with);
      CAPTURE(without);
      CHECK(without > 0.5);
      CHECK(with < kMost * without);
    }
  }
}

}  // namespace crease
