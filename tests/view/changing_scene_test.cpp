// A scene that fetches only what its mesh says has changed looks like one that is made anew.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/build_progressive_arrays.h"
#include "crease/decode_model.h"
#include "crease/progressive_mesh.h"
#include "render/gl_context.h"
#include "render/gl_scene.h"
#include "render/gl_target.h"
#include "support/mesh_zoo.h"
#include "view/streamed_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace crease {

namespace {

constexpr int kPicturePx = 120;

std::vector<std::uint8_t> picture(const GlLimits& limits, const GlScene& scene,
                                  const Camera& camera, const Box& box, bool wireframe) {
  Result<GlTarget> target = GlTarget::make(limits, kPicturePx, kPicturePx);
  REQUIRE(target.ok());
  ProgramCache programs;
  DrawPass pass{.view = make_view(camera, 1), .up = camera.up};
  pass.depth = depth_range(pass.view, box.low, box.high);
  target->begin(kPicturePx, kPicturePx);
  const DrawStyle style{.coloring = Coloring::Kind,
                        .wireframe = wireframe,
                        .reversed_depth = limits.can_reverse_depth};
  REQUIRE(scene.draw(programs, pass, style).ok());
  std::vector<std::uint8_t> rgba(4 * kPicturePx * kPicturePx);
  target->read(kPicturePx, kPicturePx, rgba);
  return rgba;
}

Camera camera_at(double angle, double distance) {
  Camera camera;
  camera.position = Vec3d{std::cos(angle), std::sin(angle), 0.4} * distance;
  camera.target = {0.5, 0.5, 0.5};
  camera.width_px = camera.height_px = kPicturePx;
  return camera;
}

struct Decoded {
  DecodedModel model;
  Box box;
};

Decoded decoded(const Mesh& mesh) {
  const StreamedModel bytes = streamed_model(mesh, 400);
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes.bytes));
  REQUIRE(file.ok());
  Result<DecodedModel> model = decode_model(*file);
  REQUIRE(model.ok());
  Decoded result{*std::move(model), {}};
  result.box.add(bytes.low);
  result.box.add(bytes.high);
  return result;
}

}  // namespace

TEST_CASE("a scene follows an adaptive mesh by its changes alone") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  for (const Mesh& mesh : {smooth_sphere(24, 48), hard_cylinder(48, 12), hard_box(12)}) {
    const Decoded all = decoded(mesh);
    Result<MeshHierarchy> hierarchy = build_hierarchy(all.model.mesh, all.model.sequence, {});
    REQUIRE(hierarchy.ok());
    AdaptiveMesh adaptive(std::make_shared<const MeshHierarchy>(*std::move(hierarchy)));
    GlScene scene(adaptive.draw_list(), {});
    std::size_t uploaded = 0;
    for (int i = 0; i < 12; ++i) {
      ViewParameters view;
      view.camera = camera_at(0.6 * i, 2 + 2 * (i % 3));
      view.camera.pixels = i % 4 == 3 ? 30 : 0.5;
      adaptive.update(view);
      uploaded += scene.update(adaptive.draw_list(), adaptive.changes());
      const GlScene anew(adaptive.draw_list(), {});
      CHECK((picture(gl->limits(), scene, view.camera, all.box, i % 2 == 0) ==
             picture(gl->limits(), anew, view.camera, all.box, i % 2 == 0)));
    }
    CHECK(uploaded > 0);
  }
}

TEST_CASE("a scene follows a progressive mesh by its changes alone") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Decoded all = decoded(hard_cylinder(48, 12));
  ProgressiveMesh levels(build_progressive_arrays(all.model.mesh, all.model.sequence));
  GlScene scene(levels.draw_list(), {});
  const std::size_t whole = scene.bytes();
  for (const double share : {0.9, 0.1, 0.5, 0.02, 1.0, 0.98}) {
    levels.set_triangle_count(std::size_t(share * double(levels.full_triangle_count())));
    const std::size_t uploaded = scene.update(levels.draw_list(), levels.changes());
    const GlScene anew(levels.draw_list(), {});
    const Camera camera = camera_at(share, 5);
    CHECK((picture(gl->limits(), scene, camera, all.box, false) ==
           picture(gl->limits(), anew, camera, all.box, false)));
    if (share == 0.98) CHECK(uploaded < whole / 5);
  }
}

}  // namespace crease
