// model.crease, versions 6 to 13: blocks from coarse to fine and a directory of them
// (docs/format.md).
//
//   Result<ByteSourcePtr> source = open_file_source("city.crease");
//   Result<BlockFile> file = BlockFile::open(*source);                     // reads 64 KiB at most
//   Result<DirectoryPage> page = file->read_page(page_of(BlockId{7}));     // keep it: 512 blocks
//   const BlockEntry& entry = page->block(BlockId{7});
//   for (BlockId needed : page->dependencies_of(BlockId{7})) ...        // coarser blocks
//   Result<std::vector<std::byte>> payload = file->read_block(entry);   // checksum verified
//
// A BlockFile keeps its head and nothing else, so every call reads what it returns. It trusts no
// byte: what it is given fails with a page or block and its byte offset, or is what the format
// says. Threads: const calls from any.
#pragma once

#include "crease/byte_source.h"
#include "crease/contraction.h"
#include "crease/ids.h"
#include "crease/mesh.h"
#include "crease/result.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

inline constexpr std::uint32_t kBlocksPerPage = 512;

// How the values of a layer are written.
enum class AttributeCoding : std::uint8_t {
  Floats,      // bit by bit
  Lattice,     // each component a code on a lattice of its own, which lies in the model tables
  Octahedral,  // directions, `bits` for each of two components
  Sextant,     // directions by sextant and two angles (Deering), `bits` in all
};

struct LayerSchema {
  std::string name;
  AttributeRole role = AttributeRole::Other;
  Interpolation interpolation = Interpolation::Linear;
  std::uint8_t dimension = 1;  // 1 to 4
  AttributeCoding coding = AttributeCoding::Floats;
  std::uint8_t bits = 0;  // 0: Floats
  bool operator==(const LayerSchema&) const = default;
};

struct BandFacts {
  std::uint32_t patches = 0;
  std::uint64_t contractions = 0;
  std::uint64_t triangles_after = 0;  // at its coarse end
  LevelError error;                   // the largest at its coarse end
};

// What holds for the whole model.
struct ModelFacts {
  Grid grid;
  std::uint8_t grid_bits = 0;  // no coordinate of a vertex is 2^grid_bits or more, either way
  std::uint64_t vertex_count = 0, triangle_count = 0;
  UpAxis up = UpAxis::Unknown;
  std::vector<LayerSchema> layers;
  std::vector<BandFacts> bands;  // finest first
};

// What the directory says of a block beside where it lies.
struct BlockFacts {
  std::uint16_t band = 0;  // ModelFacts::bands.size(): the base
  std::uint32_t patch = 0;
  // Of a sphere around all vertices of both ends, grid units; a file rounds it up by less than 2 %.
  Vec3i center;
  std::uint32_t radius = 0;
  std::uint32_t splits = 0;
  std::uint32_t vertices = 0;  // at the fine end, border included
  std::uint32_t triangles_coarse = 0, triangles_fine = 0;
  LevelError coarse, fine;          // at the two ends; a file rounds them up by less than 0.4 %
  std::uint32_t decoded_bytes = 0;  // of memory that decoding takes at most
};

struct BlockEntry {
  BlockId id{};
  BlockFacts facts;
  std::uint64_t offset = 0;  // of the payload in the file
  std::uint32_t bytes = 0;
  std::uint32_t checksum = 0;
};

constexpr std::uint32_t page_of(BlockId block) {
  return static_cast<std::uint32_t>(block) / kBlocksPerPage;
}

struct DirectoryPage {
  BlockId first{};
  std::vector<BlockEntry> blocks;              // of first, first + 1, ...
  std::vector<std::uint32_t> dependency_ends;  // per block, in dependencies
  std::vector<BlockId> dependencies;

  bool has(BlockId id) const {
    return id >= first && index_of(id) - index_of(first) < blocks.size();
  }
  // has(id) must hold.
  const BlockEntry& block(BlockId id) const { return blocks[index_of(id) - index_of(first)]; }
  // The coarser blocks that it needs, ascending. What those need in turn is not listed.
  std::span<const BlockId> dependencies_of(BlockId id) const {
    const std::size_t i = index_of(id) - index_of(first);
    const std::size_t begin = i == 0 ? 0 : dependency_ends[i - 1];
    return std::span(dependencies).subspan(begin, dependency_ends[i] - begin);
  }
};

// An image of a material, by the name that the material has for it.
struct ImageEntry {
  std::string name;
  FileRange range;
  std::uint64_t checksum = 0;
};

struct BlockFileHead {
  std::uint16_t version = 0;     // of docs/format.md
  std::uint64_t file_bytes = 0;  // of the whole, however much of it is there
  std::uint32_t head_bytes = 0;
  std::uint32_t block_count = 0;
  std::uint32_t part_count = 0;
  ModelFacts facts;
  struct Section {
    FileRange range;
    std::uint64_t checksum = 0;
  };
  Section materials, tables;
  Section parts;       // the names, behind all blocks
  Section image_list;  // behind those
  FileRange images;    // the last bytes of the file
  std::vector<FileRange> pages;
};

// Memory that one call may take. No call takes more than the bytes that there are can back: opening
// less than 1 MiB, a page its bytes, 160 a block and 16 for each dependency that it announces,
// names of parts 64 each, 1 MiB and the letters that they announce, other names at most 12 times
// their bytes, an image its own.
struct BlockFileLimits {
  std::uint64_t max_bytes = std::uint64_t(1) << 30;
};

class BlockFile {
 public:
  // Versions 6 to 13; those before, from before the first release, fail with NotSupported.
  static Result<BlockFile> open(ByteSourcePtr source, const BlockFileLimits& limits = {});

  const BlockFileHead& head() const { return head_; }
  const ModelFacts& facts() const { return head_.facts; }
  const ByteSource& source() const { return *source_; }
  std::uint32_t block_count() const { return head_.block_count; }
  std::uint32_t page_count() const { return static_cast<std::uint32_t>(head_.pages.size()); }

  // `page` must be below page_count().
  Result<DirectoryPage> read_page(std::uint32_t page) const;
  // Truncated where the block is not there yet, BadChecksum where it is another one.
  Result<std::vector<std::byte>> read_block(const BlockEntry& entry) const;

  // Empty where the file has none.
  Result<std::vector<Material>> read_materials() const;
  // Truncated while the file has not arrived as a whole: names lie at its end.
  Result<std::vector<std::string>> read_parts() const;
  bool has_parts() const;  // all that read_parts() reads is there
  Result<std::vector<std::byte>> read_tables() const;

  // What images there are; empty where the file has none. They lie at its end, so that geometry
  // comes first; Truncated while they have not arrived.
  Result<std::vector<ImageEntry>> read_image_list() const;
  Result<std::vector<std::byte>> read_image(const ImageEntry& entry) const;
  // All of them.
  Result<std::vector<ImageFile>> read_images() const;
  bool has_images() const;  // all that read_images() reads is there

  // Blocks 0 .. n - 1 are there, of a file that was cut or is still arriving. Reads one page, or
  // none where the file is whole.
  Result<std::uint32_t> complete_blocks() const;

  // Everything the container promises, every checksum among it. Empty: all of it holds.
  std::vector<std::string> validate() const;

 private:
  BlockFile(ByteSourcePtr source, const BlockFileLimits& limits, BlockFileHead head);
  Failure named(const Failure& failure) const;
  Result<std::vector<std::byte>> read_range(const FileRange& range, const std::string& what,
                                            std::uint64_t memory_factor) const;
  Result<std::vector<std::byte>> read_section(const BlockFileHead::Section& section,
                                              const char* what, std::uint64_t memory_factor) const;

  ByteSourcePtr source_;
  BlockFileLimits limits_;
  BlockFileHead head_;
};

// Of bytes that came another way, by a request for several blocks, say.
Status check_payload(const BlockEntry& entry, std::span<const std::byte> payload);
Status check_image(const ImageEntry& entry, std::span<const std::byte> bytes);

}  // namespace crease
