#include "view/scene_picture.h"

#include "render/gl_target.h"
#include "view/streamed_model.h"

#include <doctest/doctest.h>

#include <cmath>

namespace crease {

std::vector<std::uint8_t> ScenePainter::paint(const GlScene& scene, const Camera& camera,
                                              const Box& box, bool wireframe, Coloring coloring) {
  Result<GlTarget> target = GlTarget::make(limits_, kPicturePx, kPicturePx);
  REQUIRE(target.ok());
  DrawPass pass{.view = make_view(camera, 1), .up = camera.up};
  pass.depth = depth_range(pass.view, box.low, box.high);
  target->begin(kPicturePx, kPicturePx);
  const DrawStyle style{
      .coloring = coloring, .wireframe = wireframe, .reversed_depth = limits_.can_reverse_depth};
  REQUIRE(scene.draw(programs_, pass, style).ok());
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

}  // namespace crease
