// Writes a file, block by block from coarse to fine.
//
//   Result<AtomicFile> file = AtomicFile::create("city.crease");
//   Result<ContainerWriter> writer = ContainerWriter::begin(*file, {.facts = facts}, block_count);
//   for (...) writer->add(block_facts, dependencies, payload);
//   writer->finish();
//   file->commit();
//
// Every call may fail, and after a failure the file is not worth finishing. Memory: one page of the
// directory and the payloads of its 512 blocks, 16 bytes for each of the other pages, the parts'
// names and the images, which it shares.
#pragma once

#include "base/bytes.h"
#include "codec/byte_sink.h"
#include "crease/block_file.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

struct ContainerContent {
  ModelFacts facts;
  std::vector<Material> materials;
  std::vector<std::string> parts;
  std::vector<std::byte> tables;  // of primed models; may be empty
  std::vector<ImageFile> images;  // each with a name of its own
};

class ContainerWriter {
 public:
  // The sink must outlive the writer. Fails where the facts are such that no reader would take
  // them, or where they and the pages do not fit into a head.
  static Result<ContainerWriter> begin(ByteSink& sink, const ContainerContent& content,
                                       std::size_t block_count);

  // The next block. `dependencies` ascend. Errors and the sphere are rounded up to what a file can
  // say.
  Status add(const BlockFacts& block, std::span<const BlockId> dependencies,
             std::span<const std::byte> payload);

  // After the last block.
  Status finish();

 private:
  struct Page {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
  };

  explicit ContainerWriter(ByteSink& sink) : sink_(&sink) {}
  Status write_section(std::span<const std::byte> bytes);
  Status write_page();

  ByteSink* sink_;
  ModelFacts facts_;
  std::uint32_t block_count_ = 0;
  std::uint32_t head_bytes_ = 0;
  ByteWriter head_;  // from byte 32 up to the pages
  std::vector<Page> pages_;
  std::vector<std::byte> parts_;   // the names, which come behind the blocks
  std::vector<ImageFile> images_;  // which come last
  std::uint16_t layout_ = 0;
  std::vector<std::byte> image_list_;
  std::uint64_t position_ = 0;       // where the next page goes
  std::uint32_t next_ = 0;           // block
  DirectoryPage page_;               // of that block: what is behind it so far
  std::vector<std::byte> payloads_;  // of its blocks, one behind the other
};

}  // namespace crease
