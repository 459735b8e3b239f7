// Writes a file, block by block from coarse to fine.
//
//   Result<AtomicFile> file = AtomicFile::create("city.crease");
//   Result<ContainerWriter> writer = ContainerWriter::begin(*file, {.facts = facts}, counts);
//   for (...) writer->add(block_facts, dependencies, payload);
//   writer->finish();
//   file->commit();
//
// Every call may fail, and after a failure the file is not worth finishing. Memory: one page of the
// directory, 16 bytes for each of the others, the parts' names and the images, which it shares; no
// payload is kept.
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
  // The sink must outlive the writer. `dependency_counts`: of every block how many it needs, so
  // that each page's size is known before the blocks behind it. Fails where the facts are such that
  // no reader would take them, or where they and the pages do not fit into a head.
  static Result<ContainerWriter> begin(ByteSink& sink, const ContainerContent& content,
                                       std::span<const std::uint32_t> dependency_counts);

  // The next block. `dependencies` ascend. Errors are rounded up to what a file can say.
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
  Status finish_page();
  void begin_page();

  ByteSink* sink_;
  std::uint32_t block_count_ = 0;
  std::uint16_t band_count_ = 0;
  std::uint32_t head_bytes_ = 0;
  ByteWriter head_;  // from byte 32 up to the pages
  std::vector<Page> pages_;
  std::vector<std::byte> parts_;   // the names, which come behind the blocks
  std::vector<ImageFile> images_;  // which come last
  std::vector<std::byte> image_list_;
  std::uint64_t position_ = 0;         // where the next payload or page goes
  std::uint32_t next_ = 0;             // block
  ByteWriter entries_, dependencies_;  // of the page of block next_
  std::uint32_t dependency_count_ = 0, dependency_limit_ = 0;  // of that page: so far, in all
};

}  // namespace crease
