#include "view/flight.h"

#include "crease/render.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace crease {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kStepSeconds = 0.05;

Failure bad(std::size_t i, const std::string& what) {
  return fail(Error::BadFormat, "flight: [" + std::to_string(i) + "]: " + what);
}

Vec3d between(const Vec3d& a, const Vec3d& b, double share) {
  return a + (b - a) * share;
}

bool is_same_view(const Camera& a, const Camera& b) {
  return a.position == b.position && a.target == b.target && a.up == b.up;
}

}  // namespace

Result<Flight> parse_flight(std::string_view json) {
  const Json array = Json::parse(json, nullptr, false);
  if (array.is_discarded()) return fail(Error::BadFormat, "flight: not JSON");
  if (!array.is_array() || array.empty()) {
    return fail(Error::BadFormat,
                "flight: not an array of {\"seconds\":0,\"camera\":{...}} with at least one");
  }
  Flight flight;
  for (std::size_t i = 0; i < array.size(); ++i) {
    const Json& entry = array[i];
    if (!entry.is_object() || !entry.contains("seconds") || !entry["seconds"].is_number()) {
      return bad(i, "has no number \"seconds\"");
    }
    if (!entry.contains("camera")) return bad(i, "has no \"camera\"");
    const double seconds = entry["seconds"].get<double>();
    if (!(seconds >= 0 && seconds < 1e9)) return bad(i, "\"seconds\" is not between 0 and 1e9");
    if (i > 0 && seconds <= flight.back().seconds) return bad(i, "\"seconds\" do not ascend");
    const Result<Camera> camera = parse_camera(entry["camera"].dump());
    if (!camera.ok()) return bad(i, camera.failure().message);
    flight.push_back({seconds, *camera});
  }
  return flight;
}

std::string format_flight(const Flight& flight) {
  std::string text = "[";
  for (const TimedCamera& timed : flight) {
    Json entry;
    entry["seconds"] = timed.seconds;
    entry["camera"] = Json::parse(format_camera(timed.camera));
    text += (text.size() > 1 ? ",\n " : "\n ") + entry.dump();
  }
  return text + "\n]\n";
}

Camera camera_of(const Flight& flight, double seconds) {
  if (seconds <= flight.front().seconds) return flight.front().camera;
  if (seconds >= flight.back().seconds) return flight.back().camera;
  const auto after =
      std::upper_bound(flight.begin(), flight.end(), seconds,
                       [](double s, const TimedCamera& timed) { return s < timed.seconds; });
  const TimedCamera &a = *(after - 1), &b = *after;
  const double share = (seconds - a.seconds) / (b.seconds - a.seconds);
  Camera camera = a.camera;
  camera.position = between(a.camera.position, b.camera.position, share);
  camera.target = between(a.camera.target, b.camera.target, share);
  camera.up = between(a.camera.up, b.camera.up, share);
  camera.vertical_fov_deg += share * (b.camera.vertical_fov_deg - a.camera.vertical_fov_deg);
  return camera;
}

void FlightRecorder::start() {
  is_on_ = true;
  flight_.clear();
}

void FlightRecorder::add(const Camera& camera, double now) {
  if (!is_on_) return;
  if (flight_.empty()) begin_ = now;
  const double seconds = now - begin_;
  if (!flight_.empty() && seconds < flight_.back().seconds + kStepSeconds) return;
  const std::size_t count = flight_.size();
  if (count >= 2 && is_same_view(flight_[count - 2].camera, camera) &&
      is_same_view(flight_[count - 1].camera, camera)) {
    flight_.back().seconds = seconds;  // still there
    return;
  }
  flight_.push_back({seconds, camera});
}

Flight FlightRecorder::stop() {
  is_on_ = false;
  return std::exchange(flight_, {});
}

}  // namespace crease
