// A scene that fetches only what its mesh says has changed looks like one that is made anew.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/build_progressive_arrays.h"
#include "crease/progressive_mesh.h"
#include "render/gl_context.h"
#include "render/gl_scene.h"
#include "support/mesh_zoo.h"
#include "view/scene_picture.h"

#include <doctest/doctest.h>

#include <memory>

namespace crease {

TEST_CASE("a scene follows an adaptive mesh by its changes alone") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  ScenePainter painter(gl->limits());
  for (const Mesh& mesh : {smooth_sphere(24, 48), hard_cylinder(48, 12), hard_box(12)}) {
    const Decoded all = decoded(mesh);
    Result<MeshHierarchy> hierarchy = build_hierarchy(all.model.mesh, all.model.sequence, {});
    REQUIRE(hierarchy.ok());
    AdaptiveMesh adaptive(std::make_shared<const MeshHierarchy>(*std::move(hierarchy)));
    GlScene scene(adaptive.draw_list(), {}, nullptr, GL_DYNAMIC_DRAW);
    std::size_t uploaded = 0;
    for (int i = 0; i < 12; ++i) {
      ViewParameters view;
      view.camera = camera_at(0.6 * i, 2 + 2 * (i % 3));
      view.camera.pixels = i % 4 == 3 ? 30 : 0.5;
      adaptive.update(view);
      uploaded += scene.update(adaptive.draw_list(), adaptive.changes());
      const GlScene anew(adaptive.draw_list(), {});
      CHECK((painter.paint(scene, view.camera, all.box, i % 2 == 0) ==
             painter.paint(anew, view.camera, all.box, i % 2 == 0)));
    }
    CHECK(uploaded > 0);
  }
}

TEST_CASE("a scene follows a progressive mesh by its changes alone") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  ScenePainter painter(gl->limits());
  const Decoded all = decoded(hard_cylinder(48, 12));
  ProgressiveMesh levels(build_progressive_arrays(all.model.mesh, all.model.sequence));
  GlScene scene(levels.draw_list(), {}, nullptr, GL_DYNAMIC_DRAW);
  const std::size_t whole = scene.bytes();
  for (const double share : {0.9, 0.1, 0.5, 0.02, 1.0, 0.98}) {
    levels.set_triangle_count(std::size_t(share * double(levels.full_triangle_count())));
    const std::size_t uploaded = scene.update(levels.draw_list(), levels.changes());
    const GlScene anew(levels.draw_list(), {});
    const Camera camera = camera_at(share, 5);
    CHECK((painter.paint(scene, camera, all.box, false) ==
           painter.paint(anew, camera, all.box, false)));
    if (share == 0.98) CHECK(uploaded < whole / 5);
  }
}

}  // namespace crease
