#include "render/frustum.h"

#include "render/draw_arrays.h"
#include "render/palette.h"
#include "render/pixels.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace crease {

namespace {

Camera looking_at_a_unit_box() {
  Camera camera;
  camera.position = {0.5, -3, 0.7};
  camera.target = {0.5, 0.5, 0.5};
  camera.vertical_fov_deg = 40;
  camera.width_px = 400;
  camera.height_px = 300;
  return camera;
}

std::vector<Segment> lines_of(std::span<const Vec3f> points, const Camera& camera) {
  const PointSet set{{}, points};
  return frustum_lines(std::span(&set, 1), camera);
}

std::vector<Vec3f> box_corners(const Vec3f& low, const Vec3f& high) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(
        {(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y, (i & 4) ? high.z : low.z});
  }
  return corners;
}

bool is_dark(const Pixel& pixel) {
  return std::max({pixel[0], pixel[1], pixel[2]}) < 70;
}

int count_dark(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) count += is_dark(pixel_at(image, x, y));
  }
  return count;
}

}  // namespace

TEST_CASE("four lines of a frustum go from the eye through the corners of its picture") {
  const Camera camera = looking_at_a_unit_box();
  int rays = 0;
  for (const Segment& line : lines_of(box_corners({0, 0, 0}, {1, 1, 1}), camera)) {
    if (!(line.from == camera.position)) continue;
    const auto [x, y] = project(camera, line.to);
    CHECK(std::min(x, 400 - x) == doctest::Approx(0).epsilon(1e-6));
    CHECK(std::min(y, 300 - y) == doctest::Approx(0).epsilon(1e-6));
    // As far as the box, whose far side is 4 from the eye along the line of sight.
    CHECK(length(line.to - line.from) > 4);
    ++rays;
  }
  CHECK(rays == 4);
}

TEST_CASE("over a flat scene the frustum ends at the scene's top and bottom") {
  Camera camera = looking_at_a_unit_box();
  camera.position = {-100, 500, 30};
  camera.target = {500, 500, 0};
  const std::vector<Vec3f> city = box_corners({0, 0, 0}, {1000, 1000, 50});
  const std::vector<Segment> lines = lines_of(city, camera);
  REQUIRE(lines.size() > 8);
  bool cuts_the_ground = false;
  for (const Segment& line : lines) {
    for (const Vec3d& p : {line.from, line.to}) {
      if (length(p - camera.position) < 100) continue;  // the picture near the eye
      CHECK(p.z > -1e-6);
      CHECK(p.z < 60);
    }
    cuts_the_ground |= line.from.z < 1e-6 && line.to.z < 1e-6;
  }
  CHECK(cuts_the_ground);
}

TEST_CASE("a frustum that sees nothing is as long as the scene") {
  Camera camera = looking_at_a_unit_box();
  camera.target = {0.5, -10, 0.7};
  double longest = 0;
  for (const Segment& line : lines_of(box_corners({0, 0, 0}, {1, 1, 1}), camera)) {
    longest = std::max(longest, length(line.to - line.from));
  }
  CHECK(longest > 1);
  CHECK(longest < 4);
}

TEST_CASE("from outside, scene and eye are in the picture, whichever way the camera looks") {
  const std::vector<Vec3f> points = box_corners({0, 0, 0}, {1, 1, 1});
  const PointSet set{{}, points};
  for (const Vec3d& eye :
       {Vec3d{0.5, -3, 0.7}, Vec3d{0.5, 0.5, 4}, Vec3d{0.5, 0.5, 0.5}, Vec3d{-20, 3, 1}}) {
    for (const Vec3d& up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}}) {
      CAPTURE(eye.z);
      CAPTURE(up.y);
      Camera seen = looking_at_a_unit_box();
      seen.position = eye;
      seen.target = {0.4, 0.6, 0.3};
      seen.up = up;
      const Camera outside = fit_outside(std::span(&set, 1), seen, 640, 360);
      std::vector<Vec3d> all{eye};
      for (const Vec3f& p : points) all.push_back({p.x, p.y, p.z});
      for (const Vec3d& p : all) {
        const auto [x, y] = project(outside, p);
        CHECK((x > 0 && x < 640 && y > 0 && y < 360));
      }
    }
  }
}

TEST_CASE("a frustum is drawn over what is behind it and shines through what is before it") {
  const DrawArrays box(hard_box(2));
  RenderOptions options;
  options.width_px = 640;
  options.height_px = 400;
  options.frustum = looking_at_a_unit_box();
  const Image from_outside = draw(box.list(), options);
  CHECK(count_dark(from_outside) > 1000);

  // From behind the box, which hides the eye.
  options.camera = looking_at_a_unit_box();
  options.camera->position = {0.5, 8, 0.5};
  const Image hidden = draw(box.list(), options);
  options.frustum.reset();
  const Image plain = draw(box.list(), options);
  CHECK(count_dark(plain) == 0);
  int changed = 0;
  for (int row = 0; row < plain.height; ++row) {
    for (int column = 0; column < plain.width; ++column) {
      const Pixel before = pixel_at(plain, column, row), now = pixel_at(hidden, column, row);
      if (saturation(before) < 0.08 || before == now) continue;
      ++changed;
    }
  }
  CHECK(changed > 20);
}

TEST_CASE("the scale of errors is the one that is asked for, in its unit") {
  const DrawArrays box(hard_box(2));
  const std::vector<float> errors(box.list().positions.size(), 3.0f);
  const Panel panel{.list = box.list(), .title = "", .error_of_position = errors};
  RenderOptions options;
  options.width_px = 400;
  options.height_px = 400;
  options.camera = looking_at_a_unit_box();
  options.coloring = Coloring::Error;
  for (const auto& [full, share] :
       {std::pair(3 / 0.08, 0.08f), std::pair(3 / 0.92, 0.92f), std::pair(1.0, 1.0f)}) {
    options.error_full = full;
    const Result<Image> image = render_panels(std::span(&panel, 1), options);
    REQUIRE(image.ok());
    CHECK(same_hue(pixel_at(*image, 200, 190), error_color(share)));
  }
  const Result<Image> in_model_units = render_panels(std::span(&panel, 1), options);
  options.error_unit = "pixels";
  const Result<Image> in_pixels = render_panels(std::span(&panel, 1), options);
  REQUIRE(in_pixels.ok());
  CHECK(in_pixels->rgba != in_model_units->rgba);
}

}  // namespace crease
