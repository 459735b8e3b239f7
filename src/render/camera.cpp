#include "crease/render.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

namespace {

using Json = nlohmann::json;

Failure bad(Error error, const std::string& what) {
  return fail(error, "camera: " + what);
}

// Reads nothing, but hears where the text stops being JSON, without exceptions.
struct SyntaxListener : nlohmann::json_sax<Json> {
  std::size_t byte = 0;
  std::string token;
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::detail::exception&) override {
    byte = position;
    token = last_token;
    return false;
  }
};

std::string with_article(const char* type) {
  const std::string name(type);
  return (name == "object" || name == "array" ? "an " : name == "null" ? "" : "a ") + name;
}

constexpr std::array<std::string_view, 6> kFields{"position",     "target",   "up",
                                                  "vertical_fov", "viewport", "pixels"};

// How many letters to insert, leave out or replace.
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // from what of `a` came so far to each start of `b`
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i] != b[k]);
      diagonal = row[k + 1];
      row[k + 1] = std::min({replaced, diagonal + 1, row[k] + 1});
    }
  }
  return row.back();
}

// A misspelt field would be its default in silence.
Status check_fields(const Json& object) {
  for (const auto& field : object.items()) {
    const std::string& key = field.key();
    if (std::ranges::find(kFields, key) != kFields.end()) continue;
    // "fov" is a part of one, and nearer to another.
    const auto whole = std::ranges::find_if(kFields, [&](std::string_view known) {
      return key.size() >= 3 && known.find(key) != known.npos;
    });
    const std::string_view nearest =
        whole != kFields.end()
            ? *whole
            : *std::ranges::min_element(
                  kFields, {}, [&](std::string_view known) { return edits_between(key, known); });
    return bad(Error::BadFormat, "\"" + key.substr(0, 40) +
                                     "\" is no field of it; the nearest is \"" +
                                     std::string(nearest) + "\"");
  }
  return Done{};
}

// Each read_* leaves the default where the field is absent.
Status read_number(const Json& object, const char* name, double low, double high, double& value) {
  const auto at = object.find(name);
  if (at == object.end()) return Done{};
  if (!at->is_number()) {
    return bad(Error::BadFormat, std::string("\"") + name + "\" is " +
                                     with_article(at->type_name()) + ", not a number");
  }
  const double given = at->get<double>();
  if (!(given > low && given < high)) {
    char text[160];
    std::snprintf(text, sizeof text, "\"%s\" is %g, which is not above %g and below %g", name,
                  given, low, high);
    return bad(Error::BadValue, text);
  }
  value = given;
  return Done{};
}

Status read_vector(const Json& object, const char* name, bool required, Vec3d& value) {
  const auto at = object.find(name);
  const std::string quoted = std::string("\"") + name + "\"";
  if (at == object.end()) {
    if (!required) return Done{};
    return bad(Error::BadFormat, quoted + " is missing; it is [x, y, z] in model units");
  }
  if (!at->is_array() || at->size() != 3) {
    const std::string what = at->is_array() ? "an array of " + std::to_string(at->size())
                                            : with_article(at->type_name());
    return bad(Error::BadFormat, quoted + " is " + what + ", not three numbers [x, y, z]");
  }
  for (int i = 0; i < 3; ++i) {
    const Json& element = (*at)[std::size_t(i)];
    if (!element.is_number() || !std::isfinite(element.get<double>())) {
      return bad(Error::BadFormat, quoted + "[" + std::to_string(i) + "] is not a finite number");
    }
    value[i] = element.get<double>();
  }
  return Done{};
}

Status read_viewport(const Json& object, Camera& camera) {
  const auto at = object.find("viewport");
  if (at == object.end()) return Done{};
  const auto is_size = [](const Json& n) {
    return n.is_number_integer() && n.get<std::int64_t>() >= 1 && n.get<std::int64_t>() <= 65536;
  };
  if (!at->is_array() || at->size() != 2 || !is_size((*at)[0]) || !is_size((*at)[1])) {
    return bad(Error::BadValue, "\"viewport\" is not [width, height] in whole pixels, 1 to 65536");
  }
  camera.width_px = (*at)[0].get<int>();
  camera.height_px = (*at)[1].get<int>();
  return Done{};
}

}  // namespace

Result<Camera> parse_camera(std::string_view json) {
  SyntaxListener listener;
  if (!Json::sax_parse(json, &listener)) {
    return bad(Error::BadFormat, "not JSON at byte " + std::to_string(listener.byte) + ", near '" +
                                     listener.token + "'");
  }
  const Json object = Json::parse(json, nullptr, false);
  if (!object.is_object()) {
    return bad(Error::BadFormat, "the text is " + with_article(object.type_name()) +
                                     ", not an object with \"position\" and \"target\"");
  }
  Camera camera;
  for (const Status& status :
       {check_fields(object), read_vector(object, "position", true, camera.position),
        read_vector(object, "target", true, camera.target),
        read_vector(object, "up", false, camera.up), read_viewport(object, camera),
        read_number(object, "vertical_fov", 0, 180, camera.vertical_fov_deg),
        read_number(object, "pixels", 0, 1e9, camera.pixels)}) {
    if (!status.ok()) return status.failure();
  }
  if (camera.position == camera.target) {
    return bad(Error::BadValue, "\"position\" and \"target\" are the same point");
  }
  if (camera.up == Vec3d{}) return bad(Error::BadValue, "\"up\" is the zero vector");
  return camera;
}

std::string format_camera(const Camera& camera) {
  const auto array = [](const Vec3d& v) { return Json::array({v.x, v.y, v.z}); };
  nlohmann::ordered_json object;
  object["position"] = array(camera.position);
  object["target"] = array(camera.target);
  object["up"] = array(camera.up);
  object["vertical_fov"] = camera.vertical_fov_deg;
  object["viewport"] = {camera.width_px, camera.height_px};
  object["pixels"] = camera.pixels;
  return object.dump();
}

}  // namespace crease
