// Files that another one refers to.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace crease {

// The file `name` in `folder` or below it, and nowhere else: a path without "..", no absolute one,
// no link that leads out; in another case where none has its own. Fails with NotFound where there
// is none, BadValue where it would be outside, ReadFailed. Messages have the name's part only: "no
// file 'wood.png'".
Result<std::vector<std::byte>> read_in_folder(const std::filesystem::path& folder,
                                              const std::string& name, std::size_t max_bytes);

// A path of another system with slashes.
std::string with_slashes(std::string path);

struct FileInFolder {
  std::string path;  // in the folder, with slashes
  std::vector<std::byte> bytes;
};

// `name` as written, but for backslashes, and where that is nothing to read its last part in the
// folder itself: exporters write paths of their own machines.
Result<FileInFolder> find_in_folder(const std::filesystem::path& folder, const std::string& name,
                                    std::size_t max_bytes);

}  // namespace crease
