#include "crease/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace crease {

namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

Failure cannot_read(const std::filesystem::path& path, int reason) {
  return fail(reason == ENOENT ? Error::NotFound : Error::ReadFailed,
              path.string() + ": cannot be read: " + std::strerror(reason));
}

}  // namespace

Result<CreaseFile> read_crease(const std::filesystem::path& path, const DecodeLimits& limits) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return cannot_read(path, EISDIR);
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return cannot_read(path, errno);
  // In pieces: the size that a file system tells may be another one.
  std::vector<std::byte> bytes;
  constexpr std::size_t kPiece = std::size_t(1) << 20;
  const std::uintmax_t told = std::filesystem::file_size(path, error);
  if (!error && told <= limits.max_bytes) bytes.reserve(static_cast<std::size_t>(told) + 1);
  for (std::size_t end = 0;;) {
    if (end > limits.max_bytes) {
      return fail(Error::OverLimit, path.string() + ": longer than the limit of " +
                                        std::to_string(limits.max_bytes) + " bytes");
    }
    bytes.resize(end + kPiece);
    const std::size_t got = std::fread(bytes.data() + end, 1, kPiece, file.get());
    end += got;
    if (got == kPiece) continue;
    bytes.resize(end);
    if (std::ferror(file.get()) != 0) return cannot_read(path, errno);
    break;
  }
  Result<CreaseFile> decoded = decode_crease(bytes, limits);
  if (decoded.ok()) return decoded;
  return fail(decoded.failure().error, path.string() + ": " + decoded.failure().message);
}

}  // namespace crease
