#include "cli/write_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace crease::cli {

Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const std::string partial = path.string() + ".part" + std::to_string(getpid());
  const auto failed = [&](int reason) {
    std::remove(partial.c_str());
    return fail(Error::WriteFailed,
                path.string() + ": cannot be written: " + std::strerror(reason));
  };
  std::FILE* file = std::fopen(partial.c_str(), "wb");
  if (file == nullptr) return failed(errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() &&
                       std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  const int reason = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written) return failed(reason);
  if (!closed || std::rename(partial.c_str(), path.c_str()) != 0) return failed(errno);
  return Done{};
}

}  // namespace crease::cli
