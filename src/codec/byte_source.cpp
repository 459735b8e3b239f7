#include "crease/byte_source.h"

#include "codec/file_version.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace crease {

Status ByteSource::read(std::uint64_t offset, std::span<std::byte> into) const {
  const std::uint64_t there = size();
  if (offset > there || into.size() > there - offset) {
    return fail(Error::Truncated, std::to_string(into.size()) + " bytes" + at_byte(offset) +
                                      " are wanted of " + std::to_string(there));
  }
  Status status = read_at(offset, into);
  if (status.ok()) {
    bytes_read_ += into.size();
    ++read_count_;
  }
  return status;
}

void ByteSource::prefetch(std::span<const FileRange>) const {}

namespace {

class MemorySource final : public ByteSource {
 public:
  MemorySource(std::span<const std::byte> bytes, std::string name)
      : bytes_(bytes), name_(std::move(name)) {}

  std::string name() const override { return name_; }
  std::uint64_t size() const override { return bytes_.size(); }

 private:
  Status read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    const auto from = bytes_.subspan(static_cast<std::size_t>(offset), into.size());
    std::copy(from.begin(), from.end(), into.begin());
    return Done{};
  }

  std::span<const std::byte> bytes_;
  std::string name_;
};

class FileSource final : public ByteSource {
 public:
  FileSource(int file, std::string name) : file_(file), name_(std::move(name)) {}
  ~FileSource() override { ::close(file_); }

  std::string name() const override { return name_; }
  // Asked anew each time, as the file may be on its way.
  std::uint64_t size() const override {
    struct stat told {};
    return ::fstat(file_, &told) == 0 ? static_cast<std::uint64_t>(told.st_size) : 0;
  }

 private:
  Status read_at(std::uint64_t offset, std::span<std::byte> into) const override {
    while (!into.empty()) {
      const ssize_t got = ::pread(file_, into.data(), into.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) {
        return fail(Error::ReadFailed,
                    "cannot be read" + at_byte(offset) + ": " + std::strerror(errno));
      }
      if (got == 0) return fail(Error::Truncated, "it became shorter" + at_byte(offset));
      offset += static_cast<std::uint64_t>(got);
      into = into.subspan(static_cast<std::size_t>(got));
    }
    return Done{};
  }

  int file_;
  std::string name_;
};

}  // namespace

ByteSourcePtr memory_source(std::span<const std::byte> bytes, std::string name) {
  return std::make_shared<MemorySource>(bytes, std::move(name));
}

Result<ByteSourcePtr> open_file_source(const std::filesystem::path& path) {
  const auto failed = [&path](int reason) {
    return fail(reason == ENOENT ? Error::NotFound : Error::ReadFailed,
                path.string() + ": cannot be read: " + std::strerror(reason));
  };
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return failed(EISDIR);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return failed(errno);
  return ByteSourcePtr(std::make_shared<FileSource>(file, path.string()));
}

}  // namespace crease
