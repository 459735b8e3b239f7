#include "codec/small_file.h"

#include <doctest/doctest.h>

#include <filesystem>

#include <unistd.h>

namespace crease {
namespace {

struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("crease-codec-test-" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::size_t entries() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path), {}));
  }
};

TEST_CASE("a file is written whole, replaces what was there, and leaves nothing beside it") {
  const Folder folder;
  const std::filesystem::path path = folder.path / "a.crease";
  const std::vector<std::byte> first = encode_crease(*small_arrays(1), kBands);
  const std::vector<std::byte> second = encode_crease(*small_arrays(2), kBands);
  REQUIRE(write_crease(path, first).ok());
  REQUIRE(write_crease(path, second).ok());
  CHECK(folder.entries() == 1);
  const Result<CreaseFile> file = read_crease(path, {});
  REQUIRE(file.ok());
  CHECK(encode_crease(*file->arrays, file->info.bands) == second);
}

TEST_CASE("a failed write says where and why, and leaves nothing behind") {
  const Folder folder;
  const std::vector<std::byte> bytes = encode_crease(*small_arrays(1), kBands);
  const Status missing = write_crease(folder.path / "no" / "a.crease", bytes);
  REQUIRE(!missing.ok());
  CHECK(missing.failure().error == Error::WriteFailed);
  CHECK(missing.failure().message.find("a.crease: cannot be written") != std::string::npos);
  std::filesystem::create_directories(folder.path / "b.crease" / "full");
  REQUIRE(!write_crease(folder.path / "b.crease", bytes).ok());  // a folder has the name
  CHECK(folder.entries() == 1);
}

TEST_CASE("a failed read says where and why") {
  const Folder folder;
  const Result<CreaseFile> missing = read_crease(folder.path / "a.crease", {});
  REQUIRE(!missing.ok());
  CHECK(missing.failure().error == Error::NotFound);
  const Result<CreaseFile> directory = read_crease(folder.path, {});
  REQUIRE(!directory.ok());
  CHECK(directory.failure().error == Error::ReadFailed);
  const std::filesystem::path path = folder.path / "cut.crease";
  std::vector<std::byte> bytes = encode_crease(*small_arrays(1), kBands);
  bytes.resize(bytes.size() / 2);
  REQUIRE(write_crease(path, bytes).ok());
  const Result<CreaseFile> cut = read_crease(path, {});
  REQUIRE(!cut.ok());
  CHECK(cut.failure().error == Error::Truncated);
  CHECK(cut.failure().message.find("cut.crease: it has ") != std::string::npos);
  CHECK(read_crease(path, {.max_bytes = 10}).failure().error == Error::OverLimit);
}

}  // namespace
}  // namespace crease
