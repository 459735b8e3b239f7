// Bytes to a file.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace crease {

// The file appears under its name only when it is complete, and on the disk: until then, and when
// this fails, what was there stays. A symlink stays one: the file that it leads to is written. A
// pipe or a character device gets the bytes as they come. Fails with WriteFailed and the reason.
Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

// Fails as write_file() would before its first byte, for what takes long to make: the folder is not
// there, or nothing may be written in it. Leaves nothing behind, and opens no pipe.
Status check_writable(const std::filesystem::path& path);

}  // namespace crease
