// Files for tests and fuzzers: random ones, read back and written again.
#pragma once

#include "codec/encode_container.h"
#include "crease/block_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace crease {

struct WrittenBlock {
  BlockFacts facts;
  std::vector<BlockId> dependencies;
  std::vector<std::byte> payload;
};

struct WrittenFile {
  ContainerContent content;
  std::vector<WrittenBlock> blocks;
};

inline Status write_container(const WrittenFile& file, ByteSink& sink) {
  Result<ContainerWriter> writer = ContainerWriter::begin(sink, file.content, file.blocks.size());
  if (!writer.ok()) return writer.failure();
  for (const WrittenBlock& block : file.blocks) {
    Status status = writer->add(block.facts, block.dependencies, block.payload);
    if (!status.ok()) return status;
  }
  return writer->finish();
}

// Empty where the writer refuses the file.
inline std::vector<std::byte> bytes_of(const WrittenFile& file) {
  MemorySink sink;
  return write_container(file, sink).ok() ? sink.bytes() : std::vector<std::byte>();
}

// What a file says, as if it had not been written yet. The file must be valid.
inline WrittenFile read_whole(const BlockFile& file) {
  WrittenFile result;
  result.content = {file.facts(), *file.read_materials(), *file.read_parts(), *file.read_tables(),
                    *file.read_images()};
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    const DirectoryPage page = *file.read_page(p);
    for (const BlockEntry& entry : page.blocks) {
      const auto needed = page.dependencies_of(entry.id);
      result.blocks.push_back(
          {entry.facts, {needed.begin(), needed.end()}, *file.read_block(entry)});
    }
  }
  return result;
}

// Errors bit by bit.
inline bool same_facts(const BlockFacts& a, const BlockFacts& b) {
  return a.band == b.band && a.patch == b.patch && a.center == b.center && a.radius == b.radius &&
         a.splits == b.splits && a.vertices == b.vertices &&
         a.triangles_coarse == b.triangles_coarse && a.triangles_fine == b.triangles_fine &&
         a.decoded_bytes == b.decoded_bytes &&
         std::memcmp(&a.coarse, &b.coarse, sizeof a.coarse) == 0 &&
         std::memcmp(&a.fine, &b.fine, sizeof a.fine) == 0;
}

// Whatever a file says is said again by the one that is written of it. Not always in the same
// bytes: a range decoder takes some that no encoder writes.
inline bool is_written_again(const BlockFile& file) {
  const WrittenFile said = read_whole(file);
  const std::vector<std::byte> bytes = bytes_of(said);
  if (bytes.empty()) return false;
  const Result<BlockFile> again = BlockFile::open(memory_source(bytes));
  if (!again.ok() || !again->validate().empty()) return false;
  const WrittenFile read = read_whole(*again);
  if (bytes_of(read) != bytes || read.blocks.size() != said.blocks.size()) return false;
  for (std::size_t b = 0; b < said.blocks.size(); ++b) {
    const WrittenBlock &one = said.blocks[b], &other = read.blocks[b];
    if (!same_facts(one.facts, other.facts) || one.dependencies != other.dependencies ||
        one.payload != other.payload) {
      return false;
    }
  }
  return said.content.parts == read.content.parts &&
         said.content.materials == read.content.materials &&
         said.content.tables == read.content.tables;
}

inline ContainerContent some_content() {
  ContainerContent content;
  ModelFacts& facts = content.facts;
  facts.grid = {{1.5, -2e6, 0.25}, 0.125};
  facts.grid_bits = 20;
  facts.up = UpAxis::Y;
  facts.vertex_count = 5'000'000'000;
  facts.triangle_count = 9'999'999'999;
  facts.layers = {
      {"normal", AttributeRole::Normal, Interpolation::Direction, 3, AttributeCoding::Sextant, 6},
      {"bent", AttributeRole::Other, Interpolation::Direction, 3, AttributeCoding::Octahedral, 10},
      {"uv", AttributeRole::TexCoord, Interpolation::Linear, 2, AttributeCoding::Lattice, 12},
      {"kind", AttributeRole::Other, Interpolation::Categorical, 1}};
  facts.bands = {{7, 4000, 2000, {0.5f, 0.25f, 3, 0}}, {2, 1990, 10, {2, 1, 40, 0.125f}}};
  content.materials = {{"brick", {0.5f, 0.25f, 0.125f, 1}, "brick.png"}, {"", {1, 1, 1, 1}, ""}};
  content.parts = {"house", "", "shed"};
  content.tables = {std::byte{1}, std::byte{2}, std::byte{3}};
  return content;
}

inline ImageFile some_image(std::string name, std::size_t bytes) {
  std::vector<std::byte> all(bytes);
  for (std::size_t i = 0; i < bytes; ++i) all[i] = std::byte(7 * i & 0xff);
  return {std::move(name), std::make_shared<const std::vector<std::byte>>(std::move(all))};
}

inline std::vector<ImageFile> some_images() {
  return {some_image("brick.png", 40), some_image("wood.jpg", 1)};
}

// Numbers of every size, among them the largest.
inline WrittenFile random_file(std::uint64_t seed, std::size_t block_count,
                               std::size_t max_payload) {
  std::mt19937_64 random(seed);
  const auto any = [&random] {
    return static_cast<std::uint32_t>((random() & 0xffffffffu) >> (random() % 32));
  };
  const auto error = [&random] {
    return random() % 4 == 0 ? 0 : std::ldexp(float(random() % 65536), int(random() % 60) - 40);
  };
  WrittenFile file{some_content(), {}};
  for (std::size_t b = 0; b < block_count; ++b) {
    WrittenBlock block;
    BlockFacts& facts = block.facts;
    facts.band = static_cast<std::uint16_t>(random() % 3);
    facts.patch = any();
    for (int i = 0; i < 3; ++i) facts.center[i] = static_cast<std::int32_t>(any());
    for (std::uint32_t* n : {&facts.radius, &facts.splits, &facts.vertices, &facts.triangles_coarse,
                             &facts.triangles_fine, &facts.decoded_bytes}) {
      *n = any();
    }
    facts.radius /= 2;  // so that it can be rounded up
    facts.fine = {error(), error(), error(), error()};
    facts.coarse = {facts.fine.surface + error(), facts.fine.line, facts.fine.degrees + error(),
                    facts.fine.texture * 2};
    // Mostly a few, at times hundreds, and none twice.
    const std::size_t wanted = random() % 64 == 0 ? 300 : random() % 9;
    for (std::size_t i = 0; i < std::min(wanted, b); ++i) {
      block.dependencies.push_back(BlockId(static_cast<std::uint32_t>(random() % b)));
    }
    std::sort(block.dependencies.begin(), block.dependencies.end());
    block.dependencies.erase(std::unique(block.dependencies.begin(), block.dependencies.end()),
                             block.dependencies.end());
    block.payload.resize(random() % (max_payload + 1));
    for (std::byte& byte : block.payload) byte = std::byte(random() % 256);
    file.blocks.push_back(std::move(block));
  }
  return file;
}

}  // namespace crease
