// The example of docs/format.md, byte by byte, and the golden files of the container.
#include "codec/atomic_file.h"
#include "codec/container_files.h"
#include "codec/documented_file.h"
#include "crease/file.h"
#include "support/described_mesh.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace crease {
namespace {

std::filesystem::path test_folder() {
  return std::filesystem::path(__FILE__).parent_path();
}

// As docs/format-block.md has it at its end.
Mesh hip_roof() {
  Mesh roof;
  roof.positions = {{6, 4, 0}, {0, 4, 0}, {6, 0, 0}, {0, 0, 0}, {4, 2, 2}, {2, 2, 2}};
  constexpr std::uint32_t kCorners[6][3] = {{0, 1, 5}, {1, 3, 5}, {2, 4, 3},
                                            {4, 2, 0}, {4, 5, 3}, {5, 4, 0}};
  constexpr std::uint32_t kNormals[6] = {0, 2, 3, 1, 3, 0};  // A to D
  const float half_root = std::sqrt(0.5f);
  AttributeLayer normals{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
  normals.values = {0,          half_root, half_root, half_root, 0,          half_root,
                    -half_root, 0,         half_root, 0,         -half_root, half_root};
  for (std::size_t t = 0; t < 6; ++t) {
    const std::uint32_t* v = kCorners[t];
    roof.triangles.push_back({VertexId{v[0]}, VertexId{v[1]}, VertexId{v[2]}});
    for (int c = 0; c < 3; ++c) normals.of_corner.push_back(AttributeId{kNormals[t]});
  }
  roof.layers = {normals};
  return roof;
}

// Sixteen bytes a line: offset, bytes, and what of them is a letter.
std::string hex_dump(const std::vector<std::byte>& bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string dump;
  for (std::size_t line = 0; line < bytes.size(); line += 16) {
    for (int shift = 12; shift >= 0; shift -= 4) dump += kDigits[line >> shift & 15];
    dump += ' ';
    std::string letters;
    for (std::size_t i = line; i < std::min(line + 16, bytes.size()); ++i) {
      const auto value = std::to_integer<unsigned char>(bytes[i]);
      dump += {' ', kDigits[value >> 4], kDigits[value & 15]};
      letters += value > 32 && value < 127 ? static_cast<char>(value) : '.';
    }
    dump.append(3 * (16 - letters.size()) + 2, ' ');
    dump += letters + '\n';
  }
  return dump;
}

TEST_CASE("the example of docs/format.md is the roof that it says it is") {
  const std::filesystem::path path = test_folder() / "../../docs/format.md";
  const std::vector<std::byte> bytes = documented_file(path);
  REQUIRE(!bytes.empty());
  CHECK(documented_dump(path) == hex_dump(bytes));
  const Result<BlockFile> file = BlockFile::open(memory_source(bytes));
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  CHECK(validate_crease(*file).empty());
  CHECK((bytes_of(read_whole(*file)) == bytes));
  const Result<DecodedModel> model = decode_model(*file);
  REQUIRE(model.ok());
  CHECK((described(model->mesh) == described(hip_roof())));
}

// Opens the golden file, which `written` becomes where that is asked for, and writes it again.
WrittenFile golden_file(const char* name, const WrittenFile& written) {
  const std::filesystem::path path = test_folder() / "golden" / name;
  if (std::getenv("CREASE_WRITE_GOLDEN") != nullptr) {
    Result<AtomicFile> out = AtomicFile::create(path);
    REQUIRE(write_container(written, *out).ok());
    REQUIRE(out->commit().ok());
  }
  const Result<ByteSourcePtr> source = open_file_source(path);
  REQUIRE(source.ok());
  const Result<BlockFile> file = BlockFile::open(*source);
  REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
  CHECK(file->validate().empty());
  WrittenFile read = read_whole(*file);
  std::vector<std::byte> golden(static_cast<std::size_t>((*source)->size()));
  REQUIRE((*source)->read(0, golden).ok());
  CHECK((bytes_of(read) == golden));
  return read;
}

TEST_CASE("the golden files are read, and written to the byte") {
  WrittenFile without = random_file(1, 6, 24), with = without;
  with.content.images = some_images();
  WrittenFile surfaces = without;
  surfaces.content.images = {some_image("brick.png", 40)};
  surfaces.content.materials[0].alpha_cutoff = 0.25f;
  surfaces.content.materials[1].double_sided = true;
  WrittenFile blended = without;  // and so without images, of which its head speaks all the same
  blended.content.materials[1].is_blended = true;
  blended.content.materials[1].double_sided = true;
  for (const auto& [golden, written] :
       {std::pair("version_10.crease", &without), std::pair("version_11.crease", &with),
        std::pair("version_12.crease", &surfaces), std::pair("version_13.crease", &blended)}) {
    const std::string name = golden;
    CAPTURE(name);
    const WrittenFile file = golden_file(golden, *written);
    CHECK(file.blocks.size() == 6);
    const ModelFacts& facts = file.content.facts;
    CHECK(facts.triangle_count == 9'999'999'999);
    REQUIRE(facts.layers.size() == 4);
    CHECK(facts.layers[2].name == "uv");
    CHECK(facts.layers[2].bits == 12);
    REQUIRE(facts.bands.size() == 2);
    CHECK(facts.bands[1].error.degrees == 40);
    CHECK((file.content.parts == std::vector<std::string>{"house", "", "shed"}));
    CHECK(file.content.materials == written->content.materials);
    REQUIRE(file.content.images.size() == written->content.images.size());
    for (std::size_t i = 0; i < file.content.images.size(); ++i) {
      CHECK(*file.content.images[i].bytes == *written->content.images[i].bytes);
    }
  }
}

// All of it is the same.
TEST_CASE("the golden files of the versions before are read") {
  for (const auto& [before, after] : {std::pair("version_6.crease", "version_10.crease"),
                                      std::pair("version_7.crease", "version_11.crease"),
                                      std::pair("version_8.crease", "version_12.crease"),
                                      std::pair("version_9.crease", "version_13.crease")}) {
    const auto opened = [](const char* name) {
      const Result<ByteSourcePtr> source = open_file_source(test_folder() / "golden" / name);
      REQUIRE(source.ok());
      const Result<BlockFile> file = BlockFile::open(*source);
      REQUIRE_MESSAGE(file.ok(), (file.ok() ? "" : file.failure().message));
      CHECK(file->validate().empty());
      return *file;
    };
    const BlockFile old = opened(before);
    CHECK(old.head().version + 4 == opened(after).head().version);
    CHECK((bytes_of(read_whole(old)) == bytes_of(read_whole(opened(after)))));
  }
}

}  // namespace
}  // namespace crease
