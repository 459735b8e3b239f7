// Bytes to a file that appears under its name only when it is complete.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace crease::cli {

// Writes beside `path` and renames. Fails with WriteFailed and the system's reason.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace crease::cli
