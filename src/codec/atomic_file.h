// An output file (base/output_file.h) as the sink of a ContainerWriter.
//
//   Result<AtomicFile> file = AtomicFile::create("city.crease");
//   file->write(0, bytes);
//   Status status = file->commit();  // without it nothing is left
#pragma once

#include "base/output_file.h"
#include "codec/byte_sink.h"

#include <filesystem>
#include <utility>

namespace crease {

class AtomicFile final : public ByteSink {
 public:
  static Result<AtomicFile> create(const std::filesystem::path& path) {
    Result<OutputFile> file = OutputFile::create(path);
    if (!file.ok()) return file.failure();
    return AtomicFile(*std::move(file));
  }

  Status write(std::uint64_t offset, std::span<const std::byte> bytes) override {
    return file_.write(offset, bytes);
  }
  Status commit() { return file_.commit(); }

 private:
  explicit AtomicFile(OutputFile file) : file_(std::move(file)) {}

  OutputFile file_;
};

}  // namespace crease
