#include "bare_blocks.h"

#include "codec/decode_block.h"
#include "codec/lattices.h"
#include "codec/layer_values.h"

#include <ctime>
#include <utility>
#include <vector>

namespace crease::bench {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

Result<BareBlocks> decode_bare_blocks(const BlockFile& file) {
  const ModelFacts& facts = file.facts();
  Result<std::vector<std::byte>> tables = file.read_tables();
  if (!tables.ok()) return tables.failure();
  const Result<std::vector<LayerCoding>> codings = decode_codings(facts.layers, *tables);
  if (!codings.ok()) return codings.failure();
  const codec::BlockCoding coding = block_coding(facts.layers, *codings, 0, 0);

  BareBlocks result;
  std::vector<codec::FineEnd> ends, next_ends;
  std::vector<codec::CoarseEnd> starts;
  std::uint16_t band = 0;
  for (std::uint32_t p = 0; p < file.page_count(); ++p) {
    const Result<DirectoryPage> page = file.read_page(p);
    if (!page.ok()) return page.failure();
    for (const BlockEntry& entry : page->blocks) {
      const bool is_base = entry.facts.band == facts.bands.size();
      if (result.blocks == 0 || entry.facts.band != band) {
        band = entry.facts.band;
        ends = std::exchange(next_ends, {});
        starts = codec::sort_by_label(ends, is_base ? 1 : facts.bands[band].patches);
      }
      const Result<std::vector<std::byte>> payload = file.read_block(entry);
      if (!payload.ok()) return payload.failure();
      const double begin = processor_seconds();
      Result<codec::DecodedBlock> block = codec::decode_block(
          *payload, static_cast<std::uint32_t>(index_of(entry.id)), coding,
          {entry.facts.vertices, entry.facts.triangles_fine}, std::move(starts[entry.facts.patch]));
      result.seconds += processor_seconds() - begin;
      if (!block.ok()) return block.failure();
      next_ends.push_back(std::move(block->end));
      ++result.blocks;
    }
  }
  return result;
}

}  // namespace crease::bench
