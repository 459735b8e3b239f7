#include "codec/encoded_model.h"

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
  const std::vector<std::byte> first = small_case(1).bytes;
  const std::vector<std::byte> second = small_case(2).bytes;
  REQUIRE(write_crease(path, first).ok());
  REQUIRE(write_crease(path, second).ok());
  CHECK(folder.entries() == 1);
  const Result<BlockFile> file = open_crease(path);
  REQUIRE(file.ok());
  CHECK(file->source().size() == second.size());
  CHECK(validate_crease(*file).empty());
}

TEST_CASE("a failed write says where and why, and leaves nothing behind") {
  const Folder folder;
  const std::vector<std::byte> bytes = small_case(1).bytes;
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
  const Result<BlockFile> missing = open_crease(folder.path / "a.crease");
  REQUIRE(!missing.ok());
  CHECK(missing.failure().error == Error::NotFound);
  const Result<BlockFile> directory = open_crease(folder.path);
  REQUIRE(!directory.ok());
  CHECK(directory.failure().error == Error::ReadFailed);
  const std::filesystem::path path = folder.path / "cut.crease";
  std::vector<std::byte> bytes = small_case(1).bytes;
  bytes.resize(bytes.size() / 2);
  REQUIRE(write_crease(path, bytes).ok());
  const Result<BlockFile> cut = open_crease(path);  // the head is there
  REQUIRE(cut.ok());
  const Result<DecodedModel> model = decode_model(*cut);
  REQUIRE(!model.ok());
  CHECK(model.failure().error == Error::Truncated);
  CHECK(model.failure().message.find("cut.crease") != std::string::npos);
}

}  // namespace
}  // namespace crease
