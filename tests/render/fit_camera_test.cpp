#include "render/fit_camera.h"

#include "render/pixels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

namespace crease {

namespace {

struct Extent {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;  // pixels
};

Extent extent_of_box(const Camera& camera, const Vec3d& low, const Vec3d& high) {
  Extent e;
  for (int i = 0; i < 8; ++i) {
    const Vec3d corner{(i & 1) ? high.x : low.x, (i & 2) ? high.y : low.y,
                       (i & 4) ? high.z : low.z};
    const auto [x, y] = project(camera, corner);
    e.left = std::min(e.left, x);
    e.right = std::max(e.right, x);
    e.top = std::min(e.top, y);
    e.bottom = std::max(e.bottom, y);
  }
  return e;
}

}  // namespace

TEST_CASE("the fitted camera shows the whole box, as large as it fits, in the middle") {
  const Vec3d lows[] = {{0, 0, 0}, {-1, -2, -3}, {390000, 5819000, 30}, {-1e-3, -1e-3, -1e-3}};
  const Vec3d highs[] = {{1, 1, 1}, {1, 2, 3}, {395000, 5822000, 180}, {1e-3, 1e-3, 5e-3}};
  for (std::size_t i = 0; i < std::size(lows); ++i) {
    for (const auto& [w, h] : {std::pair(1920, 1080), std::pair(500, 1000)}) {
      const int width = w, height = h;
      for (const Vec3d& up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{1, 0, 0}}) {
        CAPTURE(i);
        CAPTURE(width);
        CAPTURE(up.y);
        const Camera camera = fit_camera(lows[i], highs[i], width, height, up);
        const Extent e = extent_of_box(camera, lows[i], highs[i]);
        CHECK(e.left >= 0);
        CHECK(e.top >= 0);
        CHECK(e.right <= width);
        CHECK(e.bottom <= height);
        const double filled_x = (e.right - e.left) / width, filled_y = (e.bottom - e.top) / height;
        CHECK(std::max(filled_x, filled_y) > 0.9);
        // Tight on one axis at both ends, which is what "in the middle" means in perspective.
        const double off_x = std::abs(e.left + e.right - width) / width;
        const double off_y = std::abs(e.top + e.bottom - height) / height;
        CHECK((filled_x > filled_y ? off_x : off_y) < 0.02);
      }
    }
  }
}

TEST_CASE("the fitted camera looks from above and has the scene's up up") {
  for (const Vec3d& up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}}) {
    const Camera camera = fit_camera({-1, -1, -1}, {1, 1, 1}, 800, 600, up);
    CHECK(dot(camera.position - camera.target, up) > 0);
    const auto [x0, y0] = project(camera, {0, 0, 0});
    const auto [x1, y1] = project(camera, up);
    CHECK(std::abs(x1 - x0) < 0.03 * std::abs(y1 - y0));  // but for perspective
    CHECK(y1 < y0);
  }
}

TEST_CASE("few points that are far from all others do not make these small") {
  // 1,000 points in a unit cube, and a ground or one vertex `times` as far away.
  const auto share_of_cube = [](std::vector<Vec3f> points, double times, bool ground) {
    for (int x = 0; x < 10; ++x) {
      for (int y = 0; y < 10; ++y) {
        for (int z = 0; z < 10; ++z) points.push_back({float(x) / 9, float(y) / 9, float(z) / 9});
      }
    }
    const auto far = float(times);
    points.push_back({far, far, 0});
    if (ground) points.insert(points.end(), {{-far, far, 0}, {far, -far, 0}, {-far, -far, 0}});
    const PointSet set{{700, 0, 0}, points};
    const Camera camera = fit_camera_to(std::span(&set, 1), {0, 0, 1}, 800, 800);
    const Extent e = extent_of_box(camera, {700, 0, 0}, {701, 1, 1});
    const double share = std::max(e.right - e.left, e.bottom - e.top) / 800;
    CHECK(e.left >= 0);
    CHECK(e.right <= 800);
    CHECK(e.top >= 0);
    CHECK(e.bottom <= 800);
    return share;
  };
  CHECK(share_of_cube({}, 3, true) < 0.4);  // all of that is shown
  CHECK(share_of_cube({}, 40, true) > 0.6);
  CHECK(share_of_cube({}, 40, false) > 0.6);
  // Two groups far apart are both shown.
  const std::vector<Vec3f> group(500, Vec3f{40, 40, 0});
  CHECK(share_of_cube(group, 3, true) < 0.1);
}

TEST_CASE("a box without extent still gives a camera") {
  const Camera camera = fit_camera({5, 5, 5}, {5, 5, 5}, 640, 480);
  const auto [x, y] = project(camera, {5, 5, 5});
  CHECK(std::abs(x - 320) < 1);
  CHECK(std::abs(y - 240) < 1);
}

TEST_CASE("places are those of levels of one model, and not of models apart or of other sizes") {
  const auto box = [](double low, double high) {
    return std::vector<Vec3f>{{float(low), float(low), 0},
                              {float(high), float(high), float(high - low)}};
  };
  const std::vector<Vec3f> unit = box(0, 1), smaller = box(0.1, 0.8), tiny = box(0.5, 0.55),
                           beside = box(0.9, 1.9), none;
  const PointSet sets[] = {{{}, unit},   {{0.01, 0, 0}, smaller}, {{}, tiny},
                           {{}, beside}, {{0.9, 0.9, 0}, unit},   {{100, 0, 0}, unit},
                           {{}, none},   {{50, 0, 0}, tiny}};
  const std::vector<std::uint32_t> models{0, 1, 2, 3, 4, 5, 6, 5};
  const std::vector<std::size_t> places = places_of(sets, models), wanted{0, 0, 2, 3, 3, 5, 0, 5};
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    CAPTURE(i);
    CHECK(places[i] == wanted[i]);
  }
  CHECK(places_of({}, {}).empty());
}

}  // namespace crease
