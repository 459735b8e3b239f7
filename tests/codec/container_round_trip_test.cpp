#include "codec/container.h"
#include "codec/container_files.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace crease {
namespace {

// As the docs promise: not below, and above by less than 0.4 %.
bool is_rounded_up(float written, float read) {
  return read >= written && read <= written * 1.004f + 1e-38f;
}

bool are_rounded_up(const LevelError& written, const LevelError& read) {
  return is_rounded_up(written.surface, read.surface) && is_rounded_up(written.line, read.line) &&
         is_rounded_up(written.degrees, read.degrees) &&
         is_rounded_up(written.texture, read.texture);
}

// So that the one lies within the other.
bool is_sphere_rounded_up(const BlockFacts& written, const BlockFacts& read) {
  double squared = 0;
  for (int k = 0; k < 3; ++k) {
    const double aside = double(written.center[k]) - double(read.center[k]);
    squared += aside * aside;
  }
  return std::sqrt(squared) + written.radius <= read.radius && read.radius <= 1.02 * written.radius;
}

bool same(const BlockFacts& written, const BlockFacts& read) {
  return written.band == read.band && written.patch == read.patch &&
         is_sphere_rounded_up(written, read) && written.splits == read.splits &&
         written.vertices == read.vertices && written.triangles_coarse == read.triangles_coarse &&
         written.triangles_fine == read.triangles_fine &&
         written.decoded_bytes == read.decoded_bytes &&
         are_rounded_up(written.coarse, read.coarse) && are_rounded_up(written.fine, read.fine);
}

void check_same(const ModelFacts& written, const ModelFacts& read) {
  CHECK(written.grid == read.grid);
  CHECK(written.grid_bits == read.grid_bits);
  CHECK(written.up == read.up);
  CHECK(written.vertex_count == read.vertex_count);
  CHECK(written.triangle_count == read.triangle_count);
  CHECK(written.layers == read.layers);
  REQUIRE(written.bands.size() == read.bands.size());
  for (std::size_t b = 0; b < written.bands.size(); ++b) {
    const BandFacts &w = written.bands[b], &r = read.bands[b];
    CHECK(w.patches == r.patches);
    CHECK(w.contractions == r.contractions);
    CHECK(w.triangles_after == r.triangles_after);
    CHECK(are_rounded_up(w.error, r.error));
  }
}

void check_round_trip(std::size_t block_count, std::size_t max_payload) {
  CAPTURE(block_count);
  const WrittenFile file = random_file(block_count, block_count, max_payload);
  const std::vector<std::byte> bytes = bytes_of(file);
  const Result<BlockFile> read = BlockFile::open(memory_source(bytes));
  REQUIRE_MESSAGE(read.ok(), (read.ok() ? "" : read.failure().message));
  CHECK(read->source().bytes_read() <= 65'536);
  CHECK(read->source().read_count() == 1);
  CHECK(read->head().file_bytes == bytes.size());
  check_same(file.content.facts, read->facts());
  REQUIRE(read->block_count() == block_count);
  CHECK(*read->complete_blocks() == block_count);

  const WrittenFile back = read_whole(*read);
  CHECK(back.content.materials == file.content.materials);
  CHECK(back.content.parts == file.content.parts);
  CHECK(back.content.tables == file.content.tables);
  REQUIRE(back.blocks.size() == block_count);
  std::size_t different = 0;
  for (std::size_t b = 0; b < block_count; ++b) {
    const WrittenBlock &w = file.blocks[b], &r = back.blocks[b];
    if (!same(w.facts, r.facts) || w.dependencies != r.dependencies || w.payload != r.payload) {
      ++different;
    }
  }
  CHECK(different == 0);
  CHECK(read->validate().empty());
  CHECK((bytes_of(back) == bytes));
}

TEST_CASE("blocks and what is said of them come back, and the file opens with one read") {
  for (std::size_t block_count : {0, 1, 3, 511, 512, 513, 1000, 1024}) {
    check_round_trip(block_count, 40);
  }
  check_round_trip(100'000, 12);
}

// The bytes of the section with these names, which must come back.
std::size_t bytes_of_names(std::vector<std::string> names) {
  WrittenFile file;
  file.content.parts = names;
  const std::vector<std::byte> bytes = bytes_of(file);
  const Result<BlockFile> read = BlockFile::open(memory_source(bytes));
  REQUIRE(read.ok());
  REQUIRE(read->validate().empty());
  CHECK((*read->read_parts() == names));
  return static_cast<std::size_t>(read->head().parts.range.bytes);
}

TEST_CASE("names of parts come back, and take few bytes where they are alike") {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<std::string> names(1 + random() % 30);
    for (std::string& name : names) {
      if (random() % 3 == 0) name = names[random() % names.size()];
      for (std::uint64_t i = random() % 20; i-- > 0;) name += static_cast<char>(random() >> trial);
    }
    bytes_of_names(names);
  }
  bytes_of_names({""});
  bytes_of_names({std::string(100'000, 'x'), "", std::string(100'000, 'y')});
  std::vector<std::string> houses, ids;
  for (int i = 0; i < 5000; ++i) {
    houses.push_back("house " + std::to_string(i));
    std::string id = "UUID_";
    for (int d = 0; d < 32; ++d) id += "0123456789abcdef"[random() % 16];
    ids.push_back(id);
  }
  CHECK(bytes_of_names(houses) < 5000);
  CHECK(bytes_of_names(ids) < 5000 * 17);  // 16 are random
}

TEST_CASE("images come back, behind everything else, and are read when they are asked for") {
  WrittenFile file = random_file(1, 600, 20);
  const std::vector<std::byte> without = bytes_of(file);
  file.content.images = some_images();
  const std::vector<std::byte> bytes = bytes_of(file);
  CHECK(without[8] == std::byte{10});
  CHECK(bytes[8] == std::byte{11});
  const Result<BlockFile> read = BlockFile::open(memory_source(bytes));
  REQUIRE_MESSAGE(read.ok(), (read.ok() ? "" : read.failure().message));
  CHECK(read->validate().empty());
  const FileRange& names = read->head().parts.range;
  CHECK(read->head().image_list.range.offset == names.offset + names.bytes);
  CHECK(read->head().images.offset + read->head().images.bytes == bytes.size());
  const auto images = read->read_images();
  REQUIRE(images.ok());
  REQUIRE(images->size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK((*images)[i].name == file.content.images[i].name);
    CHECK(*(*images)[i].bytes == *file.content.images[i].bytes);
  }
  CHECK((bytes_of(read_whole(*read)) == bytes));

  // The file of a stream that has all but its images.
  const std::size_t there = static_cast<std::size_t>(read->head().images.offset);
  const Result<BlockFile> part = BlockFile::open(memory_source(std::span(bytes).first(there)));
  REQUIRE(part.ok());
  CHECK(*part->complete_blocks() == 600);
  CHECK(part->read_parts().ok());
  CHECK(part->read_image_list().ok());
  CHECK(!part->has_images());
  CHECK(part->read_images().failure().error == Error::Truncated);
}

TEST_CASE("any block of 100,000 takes a read of its page and one of its own") {
  const WrittenFile file = random_file(7, 100'000, 12);
  const std::vector<std::byte> bytes = bytes_of(file);
  for (std::uint32_t b : {0u, 511u, 512u, 70'000u, 99'999u}) {
    const Result<BlockFile> read = BlockFile::open(memory_source(bytes));
    REQUIRE(read.ok());
    const Result<DirectoryPage> page = read->read_page(page_of(BlockId{b}));
    REQUIRE(page.ok());
    REQUIRE(page->has(BlockId{b}));
    const auto payload = read->read_block(page->block(BlockId{b}));
    REQUIRE(payload.ok());
    CHECK((*payload == file.blocks[b].payload));
    CHECK(read->source().read_count() == 3);
    CHECK(read->source().bytes_read() ==
          65'536 + read->head().pages[page_of(BlockId{b})].bytes + payload->size());
  }
}

TEST_CASE("a model without layers, bands, names and tables has none") {
  const WrittenFile file;
  const std::vector<std::byte> bytes = bytes_of(file);
  CHECK(bytes.size() == format::kFixedHeadBytes);
  const Result<BlockFile> read = BlockFile::open(memory_source(bytes));
  REQUIRE(read.ok());
  CHECK(read->facts().layers.empty());
  CHECK(read->facts().bands.empty());
  CHECK(read->read_materials()->empty());
  CHECK(read->read_parts()->empty());
  CHECK(read->read_tables()->empty());
  CHECK(read->page_count() == 0);
}

TEST_CASE("an error code is the least whose error is not below") {
  for (std::uint32_t c = 0; c <= format::kMaxErrorCode; ++c) {
    const auto code = static_cast<std::uint16_t>(c);
    const float error = format::error_of_code(code);
    REQUIRE(std::isfinite(error));
    REQUIRE(format::code_of_error(error) == code);
    if (c == 0) continue;
    const float below = format::error_of_code(static_cast<std::uint16_t>(c - 1));
    REQUIRE(below < error);
    REQUIRE(format::code_of_error(std::nextafter(below, error)) == code);
  }
  CHECK(format::code_of_error(-0.0f) == 0);
  CHECK(format::error_of_code(0) == 0);
}

}  // namespace
}  // namespace crease
