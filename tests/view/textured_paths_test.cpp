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
#include <optional>
#include <vector>

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

  std::vector<std::uint8_t> picture_of(ScenePainter& painter, const GlScene& scene) const {
    return painter.paint(scene, camera_above(), file.box, false, Coloring::Shaded);
  }
  void paint() const {
    materials->fill(mesh.materials, decode_textures(mesh.materials, mesh.images, {}));
  }
};

// Painted, and as if it had been uploaded anew.
void check_kept_up(ScenePainter& painter, const Painted& painted, const GlScene& scene,
                   const DrawList& list) {
  const std::vector<std::uint8_t> picture = painted.picture_of(painter, scene);
  check_painted(picture);
  CHECK((picture == painted.picture_of(painter, GlScene(list, {}, painted.materials))));
}

bool is_colorless(const std::vector<std::uint8_t>& rgba) {
  const std::uint8_t* p = &rgba[4 * (kPicturePx / 3 * kPicturePx + kPicturePx / 3)];
  return p[3] == 255 && std::abs(int(p[0]) - int(p[2])) < 24;
}

// What a stream shows on the GPU, as a picture.
class StreamPainter {
 public:
  StreamPainter(const GlLimits& limits, const Painted& painted, bool by_vertex)
      : painted_(painted),
        model_(streamed_model(painted.mesh, 200)),
        streamer_(model_.stream()),
        blocks_(painted.materials),
        cuts_(painted.materials),
        style_{.reversed_depth = limits.can_reverse_depth} {
    parameters_.view.camera = camera_above();
    parameters_.by_vertex = by_vertex;
    Result<GlTarget> target = GlTarget::make(limits, kPicturePx, kPicturePx);
    REQUIRE(target.ok());
    target_.emplace(*std::move(target));
  }

  // Until all that is wanted for this error is there.
  const BlockMesh& load(double pixels) {
    parameters_.view.camera.pixels = pixels;
    finish(streamer_, parameters_);
    blocks_.upload(streamer_.mesh().shown());
    cuts_.upload(streamer_.mesh().shown_cuts());
    return streamer_.mesh();
  }
  std::vector<std::uint8_t> picture() {
    DrawPass pass{.view = make_view(camera_above(), 1), .up = {0, 1, 0}};
    pass.depth = depth_range(pass.view, painted_.file.box.low, painted_.file.box.high);
    target_->begin(kPicturePx, kPicturePx);
    REQUIRE(blocks_.draw(programs_, pass, style_, streamer_.mesh().shown()).ok());
    REQUIRE(cuts_.draw(programs_, pass, style_, streamer_.mesh().shown_cuts()).ok());
    std::vector<std::uint8_t> rgba(4 * kPicturePx * kPicturePx);
    target_->read(kPicturePx, kPicturePx, rgba);
    return rgba;
  }

 private:
  const Painted& painted_;
  const StreamedModel model_;
  BlockStreamer streamer_;
  GlBlocks blocks_;
  GlCuts cuts_;
  const DrawStyle style_;
  BlockViewParameters parameters_;
  std::optional<GlTarget> target_;
  ProgramCache programs_;
};

}  // namespace

TEST_CASE("a level is painted, whichever it is, from when its textures are there") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  ScenePainter painter(gl->limits());
  const Painted painted;
  ProgressiveMesh levels(
      build_progressive_arrays(painted.file.model.mesh, painted.file.model.sequence));
  GlScene scene(levels.draw_list(), {}, painted.materials, GL_DYNAMIC_DRAW);
  CHECK(is_colorless(painted.picture_of(painter, scene)));
  painted.paint();
  check_painted(painted.picture_of(painter, scene));
  for (const double share : {0.3, 0.2, 0.5, 1.0}) {
    CAPTURE(share);
    levels.set_triangle_count(std::size_t(share * double(levels.full_triangle_count())));
    scene.update(levels.draw_list(), levels.changes());
    check_kept_up(painter, painted, scene, levels.draw_list());
  }
}

TEST_CASE("a cut by vertex is painted, and follows by its changes") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  ScenePainter painter(gl->limits());
  const Painted painted;
  Result<MeshHierarchy> hierarchy =
      build_hierarchy(painted.file.model.mesh, painted.file.model.sequence, {});
  REQUIRE(hierarchy.ok());
  AdaptiveMesh mesh(std::make_shared<const MeshHierarchy>(*std::move(hierarchy)));
  painted.paint();
  mesh.set_error(-1);
  GlScene scene(mesh.draw_list(), {}, painted.materials, GL_DYNAMIC_DRAW);
  for (const float error : {-1.0f, 0.0002f, 0.001f, 0.0f, -1.0f}) {
    CAPTURE(error);
    mesh.set_error(error);
    scene.update(mesh.draw_list(), mesh.changes());
    check_kept_up(painter, painted, scene, mesh.draw_list());
  }
}

TEST_CASE("blocks are painted, those that came before the textures too") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Painted painted;
  StreamPainter stream(gl->limits(), painted, false);
  stream.load(2);
  CHECK(is_colorless(stream.picture()));
  painted.paint();
  check_painted(stream.picture());
  const BlockMesh& all = stream.load(0.01);
  check_painted(stream.picture());
  CHECK(all.triangle_count() == painted.mesh.triangle_count());
}

TEST_CASE("what is shown by vertex in blocks is painted") {
  const Result<GlContext> gl = open_gl();
  REQUIRE(gl.ok());
  const Painted painted;
  painted.paint();
  StreamPainter stream(gl->limits(), painted, true);
  for (const double pixels : {2.0, 0.01}) {
    CHECK(!stream.load(pixels).shown_cuts().empty());
    check_painted(stream.picture());
  }
}

}  // namespace crease
