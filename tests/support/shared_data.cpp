#include "support/shared_data.h"

#include <algorithm>
#include <cstdlib>

namespace crease {

namespace {

// CREASE_SHARED_DATA, else the folder beside the source tree.
std::filesystem::path data_folder() {
  if (const char* given = std::getenv("CREASE_SHARED_DATA")) return given;
  // Not by __FILE__, which ccache makes a path from somewhere else.
  return std::filesystem::path(CREASE_SOURCE_FOLDER) / "../shared/data";
}

bool is_model(const std::filesystem::path& path) {
  const std::string ext = path.extension().string();
  return ext != ".bin" && ext != ".md";
}

}  // namespace

std::vector<std::filesystem::path> shared_models(const std::string& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(data_folder() / folder, none)) {
    if (entry.is_regular_file() && is_model(entry.path())) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::filesystem::path shared_model(const std::string& name) {
  const std::filesystem::path path = data_folder() / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

}  // namespace crease
