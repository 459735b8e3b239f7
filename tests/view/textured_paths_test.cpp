// A texture shows the same in every way to draw a model: by level, by vertex, by block.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "crease/build_progressive_arrays.h"
#include "crease/progressive_mesh.h"
#include "render/gl_blocks.h"
#include "render/gl_context.h"
#include "render/gl_cuts.h"
#include "render/gl_scene.h"
#include "render/gl_target.h"
#include "render/textures.h"
#include "support/painted_sheet.h"
#include "view/scene_picture.h"
#include "view/streamed_model.h"

#include <doctest/doctest.h>

#include <memory>

namespace crease {

namespace {

// The sheet is 3/4 of the picture wide, x right and y up.
Camera camera_above() {
  Camera camera;
  camera.position = {0.5, 0.5, 1};
  camera.target = {0.5, 0.5, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov_deg = 2 * std::atan(2.0 / 3) * 180 / 3.14159265358979;
  camera.width_px = camera.height_px = kPicturePx;
  return camera;
}

// `rgba` begins with the bottom row.
void check_painted(const std::vector<std::uint8_t>& rgba) {
  REQUIRE(rgba.size() == 4 * kPicturePx * kPicturePx);
  for (const double x : {0.08, 0.25, 0.38, 0.46, 0.54, 0.63, 0.75, 0.92}) {
    for (const double y : {0.08, 0.25, 0.46, 0.54, 0.75, 0.92}) {
      const auto pixel = [](double share) {
        return std::size_t(kPicturePx * (0.5 + 0.75 * (share - 0.5)));
      };
      const std::uint8_t* p = &rgba[4 * (pixel(y) * kPicturePx + pixel(x))];
      CAPTURE(x);
      CAPTURE(y);
      REQUIRE(p[3] == 255);
      CHECK(nearest_quarter(p[0], p[1], p[2]) == (x > 0.5) + 2 * (y < 0.5));
    }
  }
}

struct Painted {
  Mesh mesh = painted_sheet(24, 0.004);
  Decoded file = decoded(mesh);  // without images, as a stream is at first
  GlMaterialsPtr materials = std::make_shared<GlMaterials>();

  std::vector<std::uint8_t> picture_of(const GlLimits& limits, const GlScene& scene) const {
    return picture(limits, scene, camera_above(), file.box, false, Coloring::Shaded);
  }
  void paint() const {
    materials->fill(mesh.materials, decode_textures(mesh.materials, mesh.images, {}));
  }
};

bool is_colorless(const std::vector<std::uint8_t>& rgba) {
  const std::uint8_t* p = &rgba[4 * (kPicturePx / 3 * kPicturePx + kPicturePx / 3)];
  return p[3] == 255 && std::abs(int(p[0]) - int(p[2])) < 24;
}

}  // namespace

TEST_CASE("a level is painted, whichever it is, from when its textures are there") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Painted painted;
  ProgressiveMesh levels(
      build_progressive_arrays(painted.file.model.mesh, painted.file.model.sequence));
  GlScene scene(levels.draw_list(), {}, painted.materials);
  CHECK(is_colorless(painted.picture_of(gl->limits(), scene)));
  painted.paint();
  check_painted(painted.picture_of(gl->limits(), scene));
  for (const double share : {0.3, 0.1, 0.5, 1.0}) {
    CAPTURE(share);
    levels.set_triangle_count(std::size_t(share * double(levels.full_triangle_count())));
    scene.update(levels.draw_list(), levels.changes());
    check_painted(painted.picture_of(gl->limits(), scene));
    const GlScene anew(levels.draw_list(), {}, painted.materials);
    CHECK((painted.picture_of(gl->limits(), scene) == painted.picture_of(gl->limits(), anew)));
  }
}

TEST_CASE("a cut by vertex is painted, and follows by its changes") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Painted painted;
  Result<MeshHierarchy> hierarchy =
      build_hierarchy(painted.file.model.mesh, painted.file.model.sequence, {});
  REQUIRE(hierarchy.ok());
  AdaptiveMesh mesh(std::make_shared<const MeshHierarchy>(*std::move(hierarchy)));
  painted.paint();
  mesh.set_error(-1);
  GlScene scene(mesh.draw_list(), {}, painted.materials);
  for (const float error : {-1.0f, 0.0002f, 0.001f, 0.0f, -1.0f}) {
    CAPTURE(error);
    mesh.set_error(error);
    scene.update(mesh.draw_list(), mesh.changes());
    check_painted(painted.picture_of(gl->limits(), scene));
    const GlScene anew(mesh.draw_list(), {}, painted.materials);
    CHECK((painted.picture_of(gl->limits(), scene) == painted.picture_of(gl->limits(), anew)));
  }
}

TEST_CASE("blocks are painted, those that came before the textures too") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Painted painted;
  const StreamedModel model = streamed_model(painted.mesh, 200);
  BlockStreamer streamer = model.stream();
  GlBlocks blocks(painted.materials);
  BlockViewParameters parameters;
  parameters.view.camera = camera_above();
  Result<GlTarget> target = GlTarget::make(gl->limits(), kPicturePx, kPicturePx);
  REQUIRE(target.ok());
  ProgramCache programs;
  for (const double pixels : {2.0, 0.01}) {
    parameters.view.camera.pixels = pixels;
    finish(streamer, parameters);
    blocks.upload(streamer.mesh().shown());
    DrawPass pass{.view = make_view(camera_above(), 1), .up = {0, 1, 0}};
    pass.depth = depth_range(pass.view, painted.file.box.low, painted.file.box.high);
    const DrawStyle style{.reversed_depth = gl->limits().can_reverse_depth};
    std::vector<std::uint8_t> rgba(4 * kPicturePx * kPicturePx);
    for (const bool has_textures : {pixels < 1, true}) {
      if (has_textures) painted.paint();
      target->begin(kPicturePx, kPicturePx);
      REQUIRE(blocks.draw(programs, pass, style, streamer.mesh().shown()).ok());
      target->read(kPicturePx, kPicturePx, rgba);
      if (has_textures) check_painted(rgba);
      if (!has_textures) CHECK(is_colorless(rgba));
    }
  }
  CHECK(streamer.mesh().triangle_count() == painted.mesh.triangle_count());
}

TEST_CASE("what is shown by vertex in blocks is painted") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Painted painted;
  painted.paint();
  const StreamedModel model = streamed_model(painted.mesh, 200);
  BlockStreamer streamer = model.stream();
  GlBlocks blocks(painted.materials);
  GlCuts cuts(painted.materials);
  BlockViewParameters parameters;
  parameters.by_vertex = true;
  parameters.view.camera = camera_above();
  Result<GlTarget> target = GlTarget::make(gl->limits(), kPicturePx, kPicturePx);
  REQUIRE(target.ok());
  ProgramCache programs;
  for (const double pixels : {2.0, 0.01}) {
    parameters.view.camera.pixels = pixels;
    finish(streamer, parameters);
    blocks.upload(streamer.mesh().shown());
    cuts.upload(streamer.mesh().shown_cuts());
    REQUIRE(!streamer.mesh().shown_cuts().empty());
    DrawPass pass{.view = make_view(camera_above(), 1), .up = {0, 1, 0}};
    pass.depth = depth_range(pass.view, painted.file.box.low, painted.file.box.high);
    const DrawStyle style{.reversed_depth = gl->limits().can_reverse_depth};
    std::vector<std::uint8_t> rgba(4 * kPicturePx * kPicturePx);
    target->begin(kPicturePx, kPicturePx);
    REQUIRE(blocks.draw(programs, pass, style, streamer.mesh().shown()).ok());
    REQUIRE(cuts.draw(programs, pass, style, streamer.mesh().shown_cuts()).ok());
    target->read(kPicturePx, kPicturePx, rgba);
    check_painted(rgba);
  }
}

}  // namespace crease
