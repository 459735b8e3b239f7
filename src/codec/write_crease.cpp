#include "crease/file.h"
#include "crease/write_file.h"

namespace crease {

Status write_crease(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  return write_file(path, bytes);
}

}  // namespace crease
