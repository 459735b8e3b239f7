#include "codec/atomic_file.h"
#include "crease/file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include <unistd.h>

namespace crease {

namespace {

Failure cannot_write(const std::filesystem::path& path, int reason) {
  return fail(Error::WriteFailed, path.string() + ": cannot be written: " + std::strerror(reason));
}

}  // namespace

Result<AtomicFile> AtomicFile::create(const std::filesystem::path& path) {
  std::filesystem::path aside = path;
  aside += ".part-" + std::to_string(::getpid());
  std::FILE* file = std::fopen(aside.c_str(), "wb");
  if (file == nullptr) return cannot_write(path, errno);
  return AtomicFile(file, path, std::move(aside));
}

AtomicFile::~AtomicFile() {
  if (file_) std::remove(aside_.c_str());
}

Failure AtomicFile::failed(int reason) const {
  return cannot_write(path_, reason);
}

Status AtomicFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return Done{};
  if (offset != position_ && ::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) {
    return failed(errno);
  }
  position_ = offset + bytes.size();
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return failed(errno);
  return Done{};
}

Status AtomicFile::commit() {
  int reason = 0;
  if (std::fflush(file_.get()) != 0) reason = errno;
  if (reason == 0 && ::fsync(::fileno(file_.get())) != 0 && errno != EINVAL) reason = errno;
  if (std::fclose(file_.release()) != 0 && reason == 0) reason = errno;
  if (reason == 0 && std::rename(aside_.c_str(), path_.c_str()) != 0) reason = errno;
  if (reason == 0) return Done{};
  std::remove(aside_.c_str());
  return failed(reason);
}

Status write_crease(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) return file.failure();
  if (Status status = file->write(0, bytes); !status.ok()) return status;
  return file->commit();
}

}  // namespace crease
