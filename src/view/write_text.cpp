#include "view/write_text.h"

#include "crease/write_file.h"

#include <span>
#include <system_error>

namespace crease {

Status write_text(const std::filesystem::path& path, std::string_view text) {
  return write_file(path, std::as_bytes(std::span(text)));
}

std::filesystem::path unused_path(const std::filesystem::path& folder, const std::string& stem,
                                  const std::string& ending) {
  for (int i = 1;; ++i) {
    const std::filesystem::path path = folder / (stem + "-" + std::to_string(i) + ending);
    std::error_code error;
    if (!std::filesystem::exists(path, error)) return path;
  }
}

}  // namespace crease
