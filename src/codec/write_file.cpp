#include "crease/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <unistd.h>

namespace crease {

Status write_crease(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  // Beside the target, so that the rename stays on one file system; gone again if anything fails.
  std::filesystem::path aside = path;
  aside += ".part-" + std::to_string(::getpid());
  const auto failed = [&](int reason) {
    return fail(Error::WriteFailed,
                path.string() + ": cannot be written: " + std::strerror(reason));
  };
  std::FILE* file = std::fopen(aside.c_str(), "wb");
  if (file == nullptr) return failed(errno);
  int reason = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size()) reason = errno;
  if (reason == 0 && std::fflush(file) != 0) reason = errno;
  if (reason == 0 && ::fsync(::fileno(file)) != 0 && errno != EINVAL) reason = errno;
  if (std::fclose(file) != 0 && reason == 0) reason = errno;
  if (reason == 0 && std::rename(aside.c_str(), path.c_str()) != 0) reason = errno;
  if (reason == 0) return Done{};
  std::remove(aside.c_str());
  return failed(reason);
}

}  // namespace crease
