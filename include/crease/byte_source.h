// Where the bytes of a file come from: memory, a file, or whatever a program derives from
// ByteSource.
//
//   Result<ByteSourcePtr> source = open_file_source("city.crease");
//   Status read = (*source)->read(65536, buffer);
//   (*source)->bytes_read();  // what that cost
#pragma once

#include "crease/result.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace crease {

struct FileRange {
  std::uint64_t offset = 0, bytes = 0;
  bool operator==(const FileRange&) const = default;
};

// Random access to bytes. Threads: read() from any, if read_at() of the derived class is.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  virtual std::string name() const = 0;  // for messages; may be empty
  // How many bytes there are now: fewer than the whole where a file was cut or is still arriving.
  virtual std::uint64_t size() const = 0;

  // All of `into`, from `offset` on, or a Failure: Truncated where that is more than there is.
  Status read(std::uint64_t offset, std::span<std::byte> into) const;

  // Tells what will be read soon, so that a source far away can fetch it with few requests while
  // the caller does something else. A hint: fails never, returns at once, here does nothing.
  virtual void prefetch(std::span<const FileRange> ranges) const;

  // Over all successful reads so far. A source behind a network counts what it transferred.
  virtual std::uint64_t bytes_read() const { return bytes_read_; }
  std::uint64_t read_count() const { return read_count_; }

 private:
  // Called for what lies within size(); fills all of `into` or fails.
  virtual Status read_at(std::uint64_t offset, std::span<std::byte> into) const = 0;

  mutable std::atomic<std::uint64_t> bytes_read_{0}, read_count_{0};
};

using ByteSourcePtr = std::shared_ptr<const ByteSource>;

// The bytes must outlive the source.
ByteSourcePtr memory_source(std::span<const std::byte> bytes, std::string name = {});

// The file stays open as long as the source lives. Reading from several threads is fine.
Result<ByteSourcePtr> open_file_source(const std::filesystem::path& path);

}  // namespace crease
