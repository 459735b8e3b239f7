#include "view/remembered_views.h"

#include "codec/checksum.h"
#include "crease/http_source.h"
#include "crease/render.h"
#include "view/write_text.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>

namespace crease {

namespace {

// A path that means the same file from every folder.
std::string name_of(const std::string& source) {
  if (is_http_url(source)) return source;
  std::error_code error;
  const std::filesystem::path path =
      std::filesystem::weakly_canonical(std::filesystem::absolute(source, error), error);
  return error ? source : path.string();
}

std::filesystem::path file_of(const std::string& name) {
  const std::filesystem::path folder = state_folder();
  if (folder.empty()) return {};
  char hash[32];
  std::snprintf(hash, sizeof hash, "%016llx.json",
                static_cast<unsigned long long>(checksum(std::as_bytes(std::span(name)))));
  return folder / "views" / hash;
}

}  // namespace

std::filesystem::path state_folder() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state != nullptr && *state == '/') return std::filesystem::path(state) / "crease";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == 0) return {};
  return std::filesystem::path(home) / ".local" / "state" / "crease";
}

std::optional<Camera> remembered_view(const std::string& source) {
  const std::string name = name_of(source);
  std::ifstream in(file_of(name), std::ios::binary);
  if (!in) return std::nullopt;
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("source", nlohmann::json()) != name) return std::nullopt;
  const auto camera = json.find("camera");
  if (camera == json.end()) return std::nullopt;
  const Result<Camera> parsed = parse_camera(camera->dump());
  if (!parsed.ok()) return std::nullopt;
  return *parsed;
}

Status remember_view(const std::string& source, const Camera& camera) {
  const std::string name = name_of(source);
  const std::filesystem::path path = file_of(name);
  if (path.empty()) return Done{};
  std::error_code error;
  std::filesystem::create_directories(path.parent_path(), error);
  nlohmann::ordered_json json;
  json["source"] = name;
  json["camera"] = nlohmann::ordered_json::parse(format_camera(camera));
  return write_text(path,
                    json.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace crease
