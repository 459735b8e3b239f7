// How the mouse moves a camera.
#include "view/camera_moves.h"

#include "view/camera_input.h"

#include <doctest/doctest.h>

#include <cmath>

namespace crease {

namespace {

Camera some_camera() {
  Camera camera;
  camera.position = {3, -4, 2};
  camera.target = {1, 0, 0.5};
  camera.width_px = 800;
  camera.height_px = 600;
  return camera;
}

double off(const Vec3d& a, const Vec3d& b) {
  return length(a - b);
}

// How far a point is from the ray through a pixel.
double off_ray(const Camera& camera, double x, double y, const Vec3d& p) {
  const Ray ray = ray_through(camera, x, y);
  const Vec3d direction = normalized(ray.direction);
  const Vec3d to = p - ray.origin;
  return length(to - direction * dot(to, direction));
}

}  // namespace

TEST_CASE("whoever has zoomed in as far as it goes can zoom out again") {
  Camera camera = some_camera();
  for (int i = 0; i < 2000; ++i) camera = zoomed(camera, 0.9, camera.target);
  const double nearest = length(camera.position - camera.target);
  CHECK(nearest > 0);
  CHECK(nearest < 1e-6);
  for (int i = 0; i < 300; ++i) camera = zoomed(camera, 1 / 0.9, camera.target);
  CHECK(length(camera.position - camera.target) > 1);
}

TEST_CASE("an orbit keeps the target and the distance, and stops short of the poles") {
  Camera camera = some_camera();
  const double distance = length(camera.position - camera.target);
  for (int i = 0; i < 50; ++i) {
    camera = orbited(camera, 37, i < 25 ? 60 : -60);
    CHECK(camera.target == some_camera().target);
    CHECK(length(camera.position - camera.target) == doctest::Approx(distance));
    const Vec3d level = camera.position - camera.target;
    CHECK(std::hypot(level.x, level.y) > 0.005 * distance);
  }
  CHECK(off(orbited(orbited(camera, 40, 0), -40, 0).position, camera.position) < 1e-9);
  CHECK(off(orbited(some_camera(), 100, 0).position, some_camera().position) > 0.5);
}

TEST_CASE("what the orbit turns follows the mouse") {
  const Camera camera = some_camera();
  const Ray middle = ray_through(camera, 400, 300);
  const Vec3d front = camera.target - normalized(middle.direction) * 1.0;
  // Dragged to the right, the near side of the model moves to the right of the picture.
  const Camera moved = orbited(camera, 10, 0);
  CHECK(off_ray(moved, 410, 300, front) < off_ray(moved, 390, 300, front));
  const Camera lowered = orbited(camera, 0, 10);
  CHECK(off_ray(lowered, 400, 310, front) < off_ray(lowered, 400, 290, front));
}

TEST_CASE("a pan keeps the target under the mouse") {
  const Camera camera = some_camera();
  const Camera moved = panned(camera, 55, -20);
  CHECK(off_ray(moved, 400 + 55, 300 - 20, camera.target) < 1e-9);
  CHECK(off(moved.position - camera.position, moved.target - camera.target) < 1e-12);
}

TEST_CASE("a zoom keeps its focus where it is in the picture") {
  const Camera camera = some_camera();
  const Ray ray = ray_through(camera, 150, 480);
  const Vec3d focus = ray.origin + ray.direction * 3.0;
  const Camera moved = zoomed(camera, 0.5, focus);
  CHECK(off_ray(moved, 150, 480, focus) < 1e-9);
  CHECK(length(moved.position - focus) == doctest::Approx(0.5 * length(camera.position - focus)));
}

TEST_CASE("turning the head keeps the eye, flying keeps the direction") {
  const Camera camera = some_camera();
  const Camera looked = turned(camera, 30, 12);
  CHECK(looked.position == camera.position);
  CHECK(length(looked.target - looked.position) ==
        doctest::Approx(length(camera.target - camera.position)));
  // To the right: what was right of the middle comes nearer to it.
  const Ray right = ray_through(camera, 500, 300);
  const Vec3d there = right.origin + right.direction;
  CHECK(off_ray(looked, 400, 300, there) < off_ray(camera, 400, 300, there));

  const Vec3d ahead = normalized(camera.target - camera.position);
  const Camera flew = flown(camera, {0, 0, 2});
  CHECK(off(flew.position, camera.position + ahead * 2.0) < 1e-12);
  CHECK(off(flew.target, camera.target + ahead * 2.0) < 1e-12);
}

TEST_CASE("another target does not change the view") {
  const Camera camera = some_camera();
  const Camera moved = retargeted(camera, {0, 1, 0});
  CHECK(off_ray(camera, 400, 300, moved.target) < 1e-9);
  CHECK(moved.position == camera.position);
  CHECK(retargeted(camera, {30, -40, 20}) == camera);  // behind the eye
}

TEST_CASE("a drag of the left button orbits, of another one pans, and a short one is a click") {
  using Kind = WindowEvent::Kind;
  const PointUnder nothing = [](double, double) { return std::nullopt; };
  for (const int button : {0, 1, 2}) {
    CameraInput input;
    Camera camera = some_camera();
    input.take({.kind = Kind::Button, .code = button, .is_down = true, .x = 10, .y = 10}, 0, camera,
               nothing);
    CHECK_FALSE(input.take({.kind = Kind::Move, .x = 11, .y = 10}, 0, camera, nothing));
    CHECK(camera == some_camera());
    CHECK(input.take({.kind = Kind::Move, .x = 40, .y = 15}, 0, camera, nothing));
    CHECK((camera.target == some_camera().target) == (button == 0));
    input.take({.kind = Kind::Button, .code = button, .x = 40, .y = 15}, 0, camera, nothing);
    CHECK_FALSE(input.take_click());
    CHECK_FALSE(input.take({.kind = Kind::Move, .x = 90, .y = 15}, 0, camera, nothing));
  }
  CameraInput input;
  Camera camera = some_camera();
  for (const double now : {1.0, 1.2, 5.0}) {
    input.take({.kind = Kind::Button, .is_down = true, .x = 10, .y = 20}, now, camera, nothing);
    input.take({.kind = Kind::Button, .x = 10, .y = 20}, now, camera, nothing);
    const std::optional<Click> click = input.take_click();
    REQUIRE(click);
    CHECK(click->x == 10);
    CHECK(click->is_double == (now == 1.2));
  }
}

}  // namespace crease
