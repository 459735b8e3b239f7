#include "base/output_file.h"

#include "crease/write_file.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

namespace crease {

namespace {

Failure cannot_write(const std::filesystem::path& path, const std::string& reason) {
  return fail(Error::WriteFailed, path.string() + ": cannot be written: " + reason);
}

// Where a chain of symlinks leads to, whether or not that is there yet.
std::filesystem::path follow_links(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
    const std::filesystem::path link = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / link;  // an absolute one stands alone
  }
  return path;
}

// Not a name that can be replaced, though the system opens it: "/dev/stdout" may lead to a file
// that was deleted since.
bool leads_elsewhere(const struct ::stat& found, const std::filesystem::path& target) {
  struct ::stat at_target {};
  return ::stat(target.c_str(), &at_target) != 0 || at_target.st_dev != found.st_dev ||
         at_target.st_ino != found.st_ino;
}

struct Place {
  std::filesystem::path target;  // what is replaced
  std::filesystem::path aside;   // beside it; empty: written to as it is
};

Result<Place> place_of(const std::filesystem::path& path) {
  Place place{follow_links(path), {}};
  struct ::stat found {};
  const bool is_there = ::stat(path.c_str(), &found) == 0;
  const bool is_file = is_there && S_ISREG(found.st_mode);
  if (is_there && S_ISDIR(found.st_mode)) return cannot_write(path, std::strerror(EISDIR));
  if (is_there && !is_file && !S_ISFIFO(found.st_mode) && !S_ISCHR(found.st_mode)) {
    return cannot_write(path, S_ISBLK(found.st_mode) ? "it is a disk" : "it is a socket");
  }
  if (!is_there || (is_file && !leads_elsewhere(found, place.target))) {
    place.aside = place.target;
    place.aside += ".part-" + std::to_string(::getpid());
  }
  return place;
}

// A file of its own: another writer of the same path, a thread or a process of the same number
// elsewhere, has one as well.
std::FILE* open_new(std::filesystem::path& aside) {
  constexpr int kMostTries = 100;
  const std::filesystem::path first = aside;
  for (int i = 2;; ++i) {
    std::FILE* file = std::fopen(aside.c_str(), "wbx");
    if (file != nullptr || errno != EEXIST || i > kMostTries) return file;
    aside = first;
    aside += "-" + std::to_string(i);
  }
}

}  // namespace

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  Result<Place> place = place_of(path);
  if (!place.ok()) return place.failure();
  std::FILE* file = place->aside.empty() ? std::fopen(path.c_str(), "wb") : open_new(place->aside);
  if (file == nullptr) return cannot_write(path, std::strerror(errno));
  // What is replaced was readable for some; others are not let in.
  struct ::stat replaced {};
  if (!place->aside.empty() && ::stat(place->target.c_str(), &replaced) == 0) {
    ::fchmod(::fileno(file), replaced.st_mode & 0777);
  }
  return OutputFile(file, path, std::move(place->target), std::move(place->aside));
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : file_(std::move(other.file_)),
      name_(std::move(other.name_)),
      target_(std::move(other.target_)),
      aside_(std::exchange(other.aside_, {})),
      position_(other.position_) {}

OutputFile::~OutputFile() {
  if (!aside_.empty()) std::remove(aside_.c_str());
}

Failure OutputFile::failed(int reason) const {
  return cannot_write(name_, std::strerror(reason));
}

Status OutputFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (bytes.empty()) return Done{};
  if (offset != position_ && ::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) {
    return failed(errno);
  }
  position_ = offset + bytes.size();
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) return failed(errno);
  return Done{};
}

Status OutputFile::finish() {
  int reason = 0;
  if (std::fflush(file_.get()) != 0) reason = errno;
  const bool is_on_disk = !aside_.empty();
  if (reason == 0 && is_on_disk && ::fsync(::fileno(file_.get())) != 0 && errno != EINVAL) {
    reason = errno;
  }
  if (std::fclose(file_.release()) != 0 && reason == 0) reason = errno;
  if (reason != 0) return failed(reason);
  return Done{};
}

Status OutputFile::commit() {
  if (file_) {
    if (Status status = finish(); !status.ok()) return status;
  }
  if (aside_.empty()) return Done{};
  if (std::rename(aside_.c_str(), target_.c_str()) != 0) return failed(errno);
  aside_.clear();
  return Done{};
}

// Whoever reads a pipe would take its being opened and closed for all there is.
Status check_writable(const std::filesystem::path& path) {
  const Result<Place> place = place_of(path);
  if (!place.ok()) return place.failure();
  if (place->aside.empty()) {
    if (::access(path.c_str(), W_OK) != 0) return cannot_write(path, std::strerror(errno));
    return Done{};
  }
  const Result<OutputFile> file = OutputFile::create(path);
  if (!file.ok()) return file.failure();
  return Done{};
}

Status write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  Result<OutputFile> file = OutputFile::create(path);
  if (!file.ok()) return file.failure();
  if (Status status = file->write(0, bytes); !status.ok()) return status;
  return file->commit();
}

}  // namespace crease
