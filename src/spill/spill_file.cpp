#include "spill/spill_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace crease::spill {

namespace {

std::string reason_in(const std::filesystem::path& folder, int error) {
  return folder.string() + ": no memory in a file there: " + std::strerror(error);
}

// -1: the reason is in errno.
int open_nameless(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return descriptor;
  std::string name = (folder / ".crease-XXXXXX").string();  // file systems without O_TMPFILE
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

Result<std::unique_ptr<SpillFile>> SpillFile::create(const std::filesystem::path& folder) {
  const int descriptor = open_nameless(folder);
  if (descriptor < 0) return fail(Error::WriteFailed, reason_in(folder, errno));
  void* base =
      ::mmap(nullptr, kMostBytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (base == MAP_FAILED) {
    ::close(descriptor);
    return fail(Error::NotSupported,
                "no addresses for memory in a file; is there a limit (ulimit -v)?");
  }
  return std::unique_ptr<SpillFile>(
      new SpillFile(folder, descriptor, static_cast<std::byte*>(base)));
}

SpillFile::~SpillFile() {
  ::munmap(base_, kMostBytes);
  ::close(descriptor_);
}

void* SpillFile::allocate(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  if (bytes > kMostBytes - ranges_.end()) {
    error_ = EFBIG;
    return nullptr;
  }
  const std::uint64_t offset = ranges_.take(bytes);
  // Where the disk was full before, ranges end beyond the file.
  const std::uint64_t end = (offset + bytes + FileRanges::kPage - 1) & ~(FileRanges::kPage - 1);
  if (end > size_ && !grow_to(end)) {
    if (const Range stale = ranges_.give_back(offset); stale.size > 0) {
      ranges_.give_back_clean(stale.offset);
    }
    return nullptr;
  }
  most_used_ = std::max(most_used_, ranges_.used());
  return base_ + offset;
}

void SpillFile::free(void* memory) {
  Range stale;
  {
    const std::lock_guard lock(mutex_);
    stale = ranges_.give_back(static_cast<std::uint64_t>(static_cast<std::byte*>(memory) - base_));
  }
  if (stale.size == 0) return;
  throw_away(stale);  // may wait for the disk
  const std::lock_guard lock(mutex_);
  ranges_.give_back_clean(stale.offset);
}

bool SpillFile::grow_to(std::uint64_t size) {
  // In steps, or by what is asked for if the disk has no room for a step.
  const std::uint64_t stepped = (size + kGrowth - 1) / kGrowth * kGrowth;
  int error = EFBIG;
  for (const std::uint64_t wanted : {stepped, size}) {
    if (wanted > kMostBytes) continue;
    const auto from = static_cast<off_t>(size_), added = static_cast<off_t>(wanted - size_);
    error = ::posix_fallocate(descriptor_, from, added);
    if (error != 0) continue;
    void* mapped = ::mmap(base_ + size_, wanted - size_, PROT_READ | PROT_WRITE,
                          MAP_SHARED | MAP_FIXED, descriptor_, from);
    if (mapped == MAP_FAILED) {
      error = errno;
      continue;
    }
    size_ = wanted;
    return true;
  }
  error_ = error;
  return false;
}

void SpillFile::throw_away(const Range& range) const {
  // Where the disk was full, the end of a free range may be none of the file.
  const std::uint64_t end = std::min<std::uint64_t>(range.offset + range.size, size_);
  if (end <= range.offset) return;
  // Zeros that take no memory and need not be written, and the room stays ours. Where the file
  // system cannot do that, pages go out of memory when their turn comes.
  (void)::fallocate(descriptor_, FALLOC_FL_ZERO_RANGE | FALLOC_FL_KEEP_SIZE,
                    static_cast<off_t>(range.offset), static_cast<off_t>(end - range.offset));
}

void SpillFile::unmap_next(std::uint64_t bytes) {
  const std::uint64_t all = size_;
  if (all == 0) return;
  const std::uint64_t from = next_to_unmap_.fetch_add(bytes) % all;
  ::madvise(base_ + from, std::min(bytes, all - from), MADV_DONTNEED);
}

std::uint64_t SpillFile::most_used() const {
  const std::lock_guard lock(mutex_);
  return most_used_;
}

std::string SpillFile::failure() const {
  int error = 0;
  {
    const std::lock_guard lock(mutex_);
    error = error_;
  }
  return error == 0 ? std::string() : reason_in(folder_, error);
}

}  // namespace crease::spill
