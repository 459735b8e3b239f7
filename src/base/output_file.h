// A file that appears under its name only when it is complete.
//
//   Result<OutputFile> file = OutputFile::create("city.crease");
//   file->write(0, bytes);
//   Status status = file->commit();  // without it nothing is left
//
// What the name stands for decides how:
//   nothing, or a file    written beside it and renamed, so that no reader sees half of it
//   a symlink             the same, where it leads to; the link stays
//   a pipe, a character device (/dev/stdout, /dev/null)   written to as it is: it is no file that
//                         could be replaced, only destroyed
//   anything else         refused: a folder, a socket, a disk
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <utility>

namespace crease {

class OutputFile {
 public:
  static Result<OutputFile> create(const std::filesystem::path& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  // A pipe takes bytes in their order alone.
  Status write(std::uint64_t offset, std::span<const std::byte> bytes);
  // All bytes are on the disk; there are no more. For files that are to appear together.
  Status finish();
  // On the disk, then under its name. Once, and last.
  Status commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  OutputFile(std::FILE* file, std::filesystem::path name, std::filesystem::path target,
             std::filesystem::path aside)
      : file_(file), name_(std::move(name)), target_(std::move(target)), aside_(std::move(aside)) {}
  Failure failed(int reason) const;

  std::unique_ptr<std::FILE, Close> file_;  // null: finished, failed to, or moved from
  std::filesystem::path name_;              // as messages have it
  std::filesystem::path target_;            // what is replaced
  std::filesystem::path aside_;             // beside it; empty: written to as it is, or in place
  std::uint64_t position_ = 0;              // where the next byte would go
};

}  // namespace crease
