// The example of docs/format.md, byte by byte, and the golden files of versions 6 to 8.
#include "codec/atomic_file.h"
#include "codec/container_files.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace crease {
namespace {

std::filesystem::path test_folder() {
  return std::filesystem::path(__FILE__).parent_path();
}

std::vector<std::byte> bytes_of_text(const char* text) {
  std::vector<std::byte> bytes;
  for (; *text != '\0'; ++text) bytes.push_back(std::byte(*text));
  return bytes;
}

WrittenFile example() {
  WrittenFile file;
  ModelFacts& facts = file.content.facts;
  facts.grid = {{0, 0, 0}, 0.5};
  facts.grid_bits = 4;
  facts.vertex_count = 5;
  facts.triangle_count = 6;
  facts.layers = {{"normal", AttributeRole::Normal, Interpolation::Direction, 3,
                   AttributeCoding::Octahedral, 10}};
  facts.bands = {{1, 1, 4, {0.75f, 0, 12.5f, 0}}};
  file.content.materials = {{"red", {1, 0, 0, 1}, ""}};
  file.content.tables = bytes_of_text("prim");
  BlockFacts base;
  base.band = 1;
  base.center = {1, -1, 0};
  base.radius = 9;
  base.vertices = 4;
  base.triangles_fine = 4;
  base.coarse = base.fine = {0.75f, 0, 12.5f, 0};
  base.decoded_bytes = 256;
  BlockFacts finer = base;
  finer.band = 0;
  finer.splits = 1;
  finer.vertices = 5;
  finer.triangles_coarse = 4;
  finer.triangles_fine = 6;
  finer.fine = {};
  file.blocks = {{base, {}, bytes_of_text("base")}, {finer, {BlockId{0}}, bytes_of_text("split")}};
  return file;
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

std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_CASE("the example of docs/format.md is what is written") {
  const std::string text = read_text(test_folder() / "../../docs/format.md");
  const std::size_t heading = text.find("\n## Example\n");
  REQUIRE(heading != std::string::npos);
  const std::size_t begin = text.find("```\n", heading) + 4;
  const std::string documented = text.substr(begin, text.find("```", begin) - begin);
  const std::vector<std::byte> bytes = bytes_of(example());
  REQUIRE(!bytes.empty());
  CHECK(documented == hex_dump(bytes));
  CHECK(BlockFile::open(memory_source(bytes))->validate().empty());
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
