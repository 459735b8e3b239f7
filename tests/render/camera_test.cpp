#include "crease/render.h"

#include <doctest/doctest.h>

#include <string>

namespace crease {

TEST_CASE("a camera written and read again is the same camera") {
  Camera camera;
  camera.position = {390123.4567891234, 5819000.000000001, 1e-17};
  camera.target = {-1.0 / 3, 0.1, 2};
  camera.up = {0, 1, 0};
  camera.vertical_fov_deg = 33.3;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.pixels = 0.25;
  const Result<Camera> read = parse_camera(format_camera(camera));
  REQUIRE(read.ok());
  CHECK(read->position == camera.position);
  CHECK(read->target == camera.target);
  CHECK(read->up == camera.up);
  CHECK(read->vertical_fov_deg == camera.vertical_fov_deg);
  CHECK(read->width_px == 640);
  CHECK(read->height_px == 480);
  CHECK(read->pixels == 0.25);
}

TEST_CASE("a camera needs a position and a target, the rest has defaults") {
  const Result<Camera> read = parse_camera(R"({"position":[1,2,3],"target":[0,0,0]})");
  REQUIRE(read.ok());
  CHECK(read->position == Vec3d{1, 2, 3});
  CHECK(read->up == Vec3d{0, 0, 1});
  CHECK(read->vertical_fov_deg == 45);
  CHECK(read->width_px == 1920);
  CHECK(read->height_px == 1080);
  CHECK(read->pixels == 1);
}

TEST_CASE("a bad camera is refused with the field and what is wrong with it") {
  struct Case {
    const char* text;
    Error error;
    const char* message;  // part of it
  };
  const Case cases[] = {
      {"", Error::BadFormat, "not JSON at byte"},
      {R"({"position":[1,2,3],"target":[0,0,})", Error::BadFormat, "not JSON at byte 35"},
      {"[1,2,3]", Error::BadFormat, "is an array, not an object"},
      {R"({"target":[0,0,0]})", Error::BadFormat, "\"position\" is missing"},
      {R"({"position":[1,2,3]})", Error::BadFormat, "\"target\" is missing"},
      {R"({"position":[1,2],"target":[0,0,0]})", Error::BadFormat, "\"position\" is an array of 2"},
      {R"({"position":"here","target":[0,0,0]})", Error::BadFormat, "\"position\" is a string"},
      {R"({"position":[1,2,null],"target":[0,0,0]})", Error::BadFormat, "\"position\"[2]"},
      {R"({"position":[1,2,3],"target":[0,0,0],"pixel":5})", Error::BadFormat,
       "\"pixel\" is no field of it; the nearest is \"pixels\""},
      {R"({"position":[1,2,3],"target":[0,0,0],"fov":5})", Error::BadFormat,
       "\"fov\" is no field of it; the nearest is \"vertical_fov\""},
      {R"({"position":[1,2,3],"target":[1,2,3]})", Error::BadValue, "the same point"},
      {R"({"position":[1,2,3],"target":[0,0,0],"up":[0,0,0]})", Error::BadValue, "\"up\""},
      {R"({"position":[1,2,3],"target":[0,0,0],"vertical_fov":180})", Error::BadValue,
       "\"vertical_fov\" is 180"},
      {R"({"position":[1,2,3],"target":[0,0,0],"vertical_fov":"wide"})", Error::BadFormat,
       "\"vertical_fov\" is a string"},
      {R"({"position":[1,2,3],"target":[0,0,0],"viewport":[0,100]})", Error::BadValue,
       "\"viewport\""},
      {R"({"position":[1,2,3],"target":[0,0,0],"viewport":[1e3,100.5]})", Error::BadValue,
       "\"viewport\""},
      {R"({"position":[1,2,3],"target":[0,0,0],"pixels":-1})", Error::BadValue, "\"pixels\" is -1"},
      {R"({"position":[1,2,1e999],"target":[0,0,0]})", Error::BadFormat, "camera: "},
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    const Result<Camera> read = parse_camera(c.text);
    REQUIRE(!read.ok());
    CAPTURE(read.failure().message);
    CHECK(read.failure().error == c.error);
    CHECK(read.failure().message.find(c.message) != std::string::npos);
  }
}

}  // namespace crease
