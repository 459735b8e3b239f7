// Ambient occlusion darkens the foot of a wall, and nothing that lies open.
#include "crease/render.h"

#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

namespace crease {

namespace {

int light_at(const Image& image, int x, int y) {
  const std::size_t at = 4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
  return image.rgba[at] + image.rgba[at + 1] + image.rgba[at + 2];
}

}  // namespace

//        |##|        A box of 1 on a plane of 12 x 12, seen from ahead and above.
//   _____|##|_____
TEST_CASE("the ground is darker at the foot of a box, and as before away from it") {
  Mesh mesh = hard_box(1);
  // The ground: the box's lower side, widened, has a normal of its own that points down.
  Mesh ground = hard_box(1);
  for (Vec3d& p : ground.positions) p = {12 * p.x - 5.5, 12 * p.y - 5.5, p.z - 1};
  const MeshDrawArrays box_arrays(mesh), ground_arrays(ground);
  // One list of both, by hand: their parts are flat ones only.
  const DrawList box = box_arrays.draw_list(), flat = ground_arrays.draw_list();
  std::vector<Vec3f> positions, normals;
  std::vector<std::uint32_t> indices;
  for (const DrawList* list : {&box, &flat}) {
    const auto first = std::uint32_t(positions.size());
    for (const Vec3f& p : list->positions) {
      positions.push_back(
          p + Vec3f{float(list->origin.x), float(list->origin.y), float(list->origin.z)});
    }
    for (const std::uint32_t i : list->fn.indices) indices.push_back(first + i);
    normals.insert(normals.end(), list->fn.normals.begin(), list->fn.normals.end());
  }
  DrawList both;
  both.positions = positions;
  both.fn.indices = indices;
  both.fn.normals = normals;
  Panel panel;
  panel.list = both;

  RenderOptions options;
  options.width_px = 300;
  options.height_px = 200;
  Camera camera;
  camera.position = {0.5, -4, 3};
  camera.target = {0.5, 0.5, 0.3};
  options.camera = camera;
  const Result<Image> open = render_panels(std::span(&panel, 1), options);
  options.ambient_occlusion = true;
  const Result<Image> occluded = render_panels(std::span(&panel, 1), options);
  REQUIRE(open.ok());
  REQUIRE(occluded.ok());
  int darker = 0, lighter = 0, first_dark_row = -1;
  for (int y = 0; y < 200; ++y) {
    const int change = light_at(*occluded, 150, y) - light_at(*open, 150, y);
    darker += change < -15;
    lighter += change > 3;
    if (change < -15 && first_dark_row < 0) first_dark_row = y;
  }
  CHECK(lighter == 0);
  CHECK(darker > 2);   // around the foot
  CHECK(darker < 40);  // and nowhere else
  CHECK(first_dark_row > 60);
  for (const int y : {190, 198}) {  // the ground ahead lies open
    CHECK(std::abs(light_at(*occluded, 150, y) - light_at(*open, 150, y)) <= 3);
  }
  for (int x = 0; x < 300; x += 7)
    CHECK(light_at(*occluded, x, 0) == light_at(*open, x, 0));  // sky
}

}  // namespace crease
