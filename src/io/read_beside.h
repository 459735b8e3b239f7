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

}  // namespace crease
