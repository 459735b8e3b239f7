#include "view/flight.h"

#include <doctest/doctest.h>

#include <string>

namespace crease {

namespace {

Camera camera_aside(double x) {
  Camera camera;
  camera.position = {x, 0, 5};
  camera.target = {x, 1, 0};
  return camera;
}

}  // namespace

TEST_CASE("a flight is read as it was written") {
  const Flight flight{{0, camera_aside(1)}, {0.5, camera_aside(2)}, {3, camera_aside(-7)}};
  const Result<Flight> read = parse_flight(format_flight(flight));
  REQUIRE(read.ok());
  REQUIRE(read->size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK((*read)[i].seconds == flight[i].seconds);
    CHECK((*read)[i].camera == flight[i].camera);
  }
}

TEST_CASE("what is no flight is told by its place") {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "not JSON"},
      {"{}", "not an array"},
      {"[]", "at least one"},
      {"[1]", "[0]"},
      {R"([{"seconds":0}])", "\"camera\""},
      {R"([{"seconds":-1,"camera":{"position":[0,0,1],"target":[0,0,0]}}])", "between"},
      {R"([{"seconds":0,"camera":{"position":[0,0,1]}}])", "\"target\" is missing"},
      {R"([{"seconds":0,"camera":{"position":[0,0,1],"target":[0,0,0]}},
           {"seconds":0,"camera":{"position":[0,0,1],"target":[0,0,0]}}])",
       "[1]: \"seconds\" do not ascend"}};
  for (const auto& [text, words] : wrong) {
    const Result<Flight> flight = parse_flight(text);
    REQUIRE_FALSE(flight.ok());
    CHECK(flight.failure().message.find(words) != std::string::npos);
  }
}

TEST_CASE("between two cameras lies a camera between them, before and after all the ends") {
  const Flight flight{{1, camera_aside(0)}, {2, camera_aside(10)}, {4, camera_aside(20)}};
  CHECK(camera_of(flight, 0) == camera_aside(0));
  CHECK(camera_of(flight, 9) == camera_aside(20));
  CHECK(camera_of(flight, 1.5).position.x == doctest::Approx(5));
  CHECK(camera_of(flight, 2) == camera_aside(10));
  CHECK(camera_of(flight, 3).target.x == doctest::Approx(15));
}

TEST_CASE("a recording begins at 0 and keeps what moves, not every frame of what stays") {
  FlightRecorder recorder;
  recorder.add(camera_aside(9), 99);  // not on yet
  recorder.start();
  double now = 100;
  for (int i = 0; i < 100; ++i) recorder.add(camera_aside(1), now += 0.06);
  for (int i = 0; i < 10; ++i) recorder.add(camera_aside(2 + i), now += 0.06);
  recorder.add(camera_aside(50), now + 0.001);  // too soon
  const Flight flight = recorder.stop();
  CHECK_FALSE(recorder.is_on());
  REQUIRE(flight.size() == 12);
  CHECK(flight[0].seconds == 0);
  CHECK(flight[1].seconds == doctest::Approx(99 * 0.06));
  CHECK(flight[1].camera == camera_aside(1));
  CHECK(flight.back().camera == camera_aside(11));
  CHECK(parse_flight(format_flight(flight)).ok());
}

}  // namespace crease
