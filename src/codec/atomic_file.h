// A file that appears under its name only when it is complete.
//
//   Result<AtomicFile> file = AtomicFile::create("city.crease");
//   file->write(0, bytes);
//   Status status = file->commit();  // without it nothing is left
#pragma once

#include "codec/byte_sink.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace crease {

class AtomicFile final : public ByteSink {
 public:
  // Beside `path`, so that the last step, a rename, stays on one file system.
  static Result<AtomicFile> create(const std::filesystem::path& path);

  AtomicFile(AtomicFile&&) = default;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile() override;

  Status write(std::uint64_t offset, std::span<const std::byte> bytes) override;
  // On the disk, then under its name. Once, and last.
  Status commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  AtomicFile(std::FILE* file, std::filesystem::path path, std::filesystem::path aside)
      : file_(file), path_(std::move(path)), aside_(std::move(aside)) {}
  Failure failed(int reason) const;

  std::unique_ptr<std::FILE, Close> file_;  // null: committed, failed to, or moved from
  std::filesystem::path path_, aside_;
  std::uint64_t position_ = 0;  // where the next byte would go
};

}  // namespace crease
