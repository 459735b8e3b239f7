// Small files that appear under their names only when they are complete.
#pragma once

#include "crease/result.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace crease {

Status write_text(const std::filesystem::path& path, std::string_view text);

// The first of STEM-1.ENDING, STEM-2.ENDING, ... in `folder` that is not there.
std::filesystem::path unused_path(const std::filesystem::path& folder, const std::string& stem,
                                  const std::string& ending);

}  // namespace crease
