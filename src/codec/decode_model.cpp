#include "crease/decode_model.h"

#include "codec/lattices.h"
#include "codec/model_of_blocks.h"
#include "codec/unfold_blocks.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

namespace crease {

namespace {

using codec::BlockUnfolder;
using codec::CoarseEnd;
using codec::DecodedBlock;
using codec::FineEnd;

// A block that will be decoded.
struct Chosen {
  BlockEntry entry;
  std::vector<BlockId> dependencies;
};

std::string name_of(const BlockEntry& entry) {
  return "block " + std::to_string(index_of(entry.id));
}

Failure bad(const BlockEntry& entry, const char* what) {
  return fail(Error::BadFormat, name_of(entry) + ": " + what);
}

StreamBits named(const codec::StreamBits& bits) {
  const auto of = [&bits](codec::Stream stream) { return bits[std::size_t(stream)]; };
  return {of(codec::Stream::Roots),     of(codec::Stream::Flags),      of(codec::Stream::Shapes),
          of(codec::Stream::Positions), of(codec::Stream::Categories), of(codec::Stream::Values),
          of(codec::Stream::Labels)};
}

class ModelDecoder {
 public:
  ModelDecoder(const BlockFile& file, const DecodeOptions& options)
      : file_(file), options_(options), facts_(file.facts()) {}

  Result<DecodedModel> run() {
    if (Status status = read_schema(); !status.ok()) return status.failure();
    if (Status status = choose_blocks(); !status.ok()) return status.failure();
    if (options_.count_bits) model_.bits.resize(facts_.bands.size() + 1);
    // chosen_ goes from the base to the finest band, as the file does. While a band is decoded, the
    // next one is on its way.
    std::size_t end = end_of_band(0);
    prefetch(0, end);
    for (std::size_t begin = 0; begin < chosen_.size(); begin = end) {
      end = end_of_band(begin);
      prefetch(end, end_of_band(end));
      if (Status status = decode_band(begin, end); !status.ok()) return status.failure();
    }
    return finish();
  }

 private:
  Status read_schema() {
    Result<std::vector<std::byte>> tables = file_.read_tables();
    if (!tables.ok()) return tables.failure();
    Result<std::vector<LayerCoding>> codings = decode_codings(facts_.layers, *tables);
    if (!codings.ok()) return codings.failure();
    codings_ = *std::move(codings);
    Result<std::vector<Material>> materials = file_.read_materials();
    if (!materials.ok()) return materials.failure();
    model_.mesh.materials = *std::move(materials);
    Result<std::vector<std::string>> parts = file_.read_parts();
    if (!parts.ok()) return parts.failure();
    model_.mesh.parts = *std::move(parts);
    coding_ = block_coding(facts_.layers, codings_, model_.mesh.materials.size(),
                           model_.mesh.parts.size());
    return Done{};
  }

  // What is wanted and what that needs. What the entries promise is checked here, so that nothing
  // is decoded in vain.
  Status choose_blocks() {
    std::vector<Chosen> all;
    if (Status status = read_directory(all); !status.ok()) return status.failure();
    std::vector<char> is_needed(all.size(), 0);
    for (std::size_t i = all.size(); i-- > 0;) {
      const BlockEntry& entry = all[i].entry;
      const bool is_base = entry.facts.band == facts_.bands.size();
      if (!is_base && !is_needed[i] && options_.wants && !options_.wants(entry)) continue;
      is_needed[i] = 1;
      for (const BlockId id : all[i].dependencies) is_needed[index_of(id)] = 1;
    }
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!is_needed[i]) continue;
      const BlockFacts& facts = all[i].entry.facts;
      if (codec::decoded_bytes({facts.vertices, facts.triangles_fine}, facts_.layers.size()) >
          facts.decoded_bytes) {
        return bad(all[i].entry, "it takes more memory than it says");
      }
      bytes += facts.decoded_bytes;
      if (bytes > options_.max_bytes) {
        return fail(Error::OverLimit, name_of(all[i].entry) + ": decoded blocks take more than " +
                                          std::to_string(options_.max_bytes) + " bytes");
      }
      chosen_.push_back(std::move(all[i]));
    }
    return Done{};
  }

  // Of the band that chosen_[begin] is of.
  std::size_t end_of_band(std::size_t begin) const {
    std::size_t end = begin;
    while (end < chosen_.size() &&
           chosen_[end].entry.facts.band == chosen_[begin].entry.facts.band) {
      ++end;
    }
    return end;
  }

  void prefetch(std::size_t begin, std::size_t end) const {
    std::vector<FileRange> ranges;
    for (std::size_t i = begin; i < end; ++i) {
      ranges.push_back({chosen_[i].entry.offset, chosen_[i].entry.bytes});
    }
    file_.source().prefetch(ranges);
  }

  // The entries of all blocks down to the finest band, which are the first ones.
  Status read_directory(std::vector<Chosen>& all) const {
    if (options_.finest_band == 0) file_.source().prefetch(file_.head().pages);
    const std::size_t bands = facts_.bands.size();
    std::vector<std::uint32_t> blocks_of_band(bands + 1, 0);
    std::size_t band_before = bands;
    for (std::uint32_t p = 0; p < file_.page_count(); ++p) {
      const Result<DirectoryPage> page = file_.read_page(p);
      if (!page.ok()) return page.failure();
      for (const BlockEntry& entry : page->blocks) {
        const BlockFacts& facts = entry.facts;
        if (facts.band > band_before) return bad(entry, "it is not behind the coarser ones");
        band_before = facts.band;
        if (facts.patch != blocks_of_band[facts.band]++) return bad(entry, "not the next patch");
        if (facts.band < options_.finest_band) return check_counts(blocks_of_band);
        const std::span<const BlockId> needed = page->dependencies_of(entry.id);
        all.push_back({entry, {needed.begin(), needed.end()}});
      }
    }
    return check_counts(blocks_of_band);
  }

  // Of bands of which all blocks were seen.
  Status check_counts(const std::vector<std::uint32_t>& blocks_of_band) const {
    for (std::size_t b = options_.finest_band; b < facts_.bands.size(); ++b) {
      if (blocks_of_band[b] != facts_.bands[b].patches) {
        return fail(Error::BadFormat, "band " + std::to_string(b) +
                                          ": it has not as many blocks "
                                          "as patches");
      }
    }
    if (blocks_of_band.back() > 1) return fail(Error::BadFormat, "more than one base");
    return Done{};
  }

  Status decode_band(std::size_t begin, std::size_t end) {
    const std::uint16_t band = chosen_[begin].entry.facts.band;
    const bool is_base = band == facts_.bands.size();
    const std::uint32_t patches = is_base ? 1 : facts_.bands[band].patches;
    std::vector<CoarseEnd> starts = codec::sort_by_label(ends_, patches);
    std::vector<Result<DecodedBlock>> decoded(end - begin, fail(Error::BadFormat, ""));
    std::vector<codec::StreamBits> bits(end - begin, codec::StreamBits{});
    std::vector<BlockUnfolder::Start> unfolded(end - begin);
    const auto decode = [&](std::size_t i) {
      const BlockEntry& entry = chosen_[begin + i].entry;
      CoarseEnd& start = starts[is_base ? 0 : entry.facts.patch];
      unfolded[i].names = start.names;
      unfolded[i].sources = std::move(start.sources);
      decoded[i] = decode_one(entry, std::move(start), options_.count_bits ? &bits[i] : nullptr);
    };
    if (options_.for_each) {
      options_.for_each(decoded.size(), decode);
    } else {
      for (std::size_t i = 0; i < decoded.size(); ++i) decode(i);
    }

    const std::uint32_t first = static_cast<std::uint32_t>(unfolder_.blocks().size());
    std::vector<FineEnd> ends;
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      const BlockEntry& entry = chosen_[begin + i].entry;
      if (!decoded[i].ok()) return decoded[i].failure();
      if (options_.count_bits) model_.bits[band] += named(bits[i]);
      model_.blocks.push_back(entry.id);
      model_.payload_bytes += entry.bytes;
      ends.push_back(decoded[i]->end);
      for (codec::TriangleSource& source : unfolded[i].sources) source.end += first_end_;
      unfolder_.add(entry, *std::move(decoded[i]), unfolded[i]);
    }
    ends_ = std::move(ends);
    first_end_ = first;
    return Done{};
  }

  Result<DecodedBlock> decode_one(const BlockEntry& entry, CoarseEnd start,
                                  codec::StreamBits* bits) const {
    if (start.mesh.triangles.size() != entry.facts.triangles_coarse) {
      return bad(entry, "it starts from other triangles than it says");
    }
    const Result<std::vector<std::byte>> payload = file_.read_block(entry);
    if (!payload.ok()) return payload.failure();
    const std::size_t names = start.names.size();
    Result<DecodedBlock> block = codec::decode_block(
        *payload, static_cast<std::uint32_t>(index_of(entry.id)), coding_,
        {entry.facts.vertices, entry.facts.triangles_fine}, std::move(start), bits);
    if (!block.ok()) return block.failure();
    if (block->end.mesh.positions.size() != entry.facts.vertices ||
        block->end.mesh.triangles.size() != entry.facts.triangles_fine ||
        block->splits.size() != entry.facts.splits) {
      return bad(entry, "it holds other counts than it says");
    }
    if (!is_on_grid(*block)) return bad(entry, "a vertex lies outside of the grid");
    for (std::size_t v = names; v < block->end.names.size(); ++v) {
      const codec::VertexName& name = block->end.names[v];
      if (name.block != index_of(entry.id) && !unfolder_.has(name)) {
        return bad(entry, "it names a vertex that no coarser block has");
      }
    }
    return block;
  }

  // As the head says: no coordinate is 2^grid_bits or more, either way.
  bool is_on_grid(const DecodedBlock& block) const {
    const std::int64_t limit = std::int64_t(1) << facts_.grid_bits;
    const auto is_inside = [limit](const Vec3i& p) {
      return std::max({std::abs(std::int64_t(p.x)), std::abs(std::int64_t(p.y)),
                       std::abs(std::int64_t(p.z))}) < limit;
    };
    return std::all_of(block.end.mesh.positions.begin(), block.end.mesh.positions.end(),
                       is_inside) &&
           std::all_of(block.splits.begin(), block.splits.end(),
                       [&](const codec::Split& split) { return is_inside(split.parent_position); });
  }

  Result<DecodedModel> finish() {
    ends_.clear();
    model_.sequence.grid = facts_.grid;
    codec::ModelOfBlocks(facts_, codings_, coding_, unfolder_).fill(model_);
    if (Status status = check_mesh(model_.mesh); !status.ok()) {
      return fail(Error::BadFormat, "decoded mesh: " + status.failure().message);
    }
    return std::move(model_);
  }

  const BlockFile& file_;
  const DecodeOptions& options_;
  const ModelFacts& facts_;
  std::vector<LayerCoding> codings_;
  codec::BlockCoding coding_;
  std::vector<Chosen> chosen_;
  std::vector<FineEnd> ends_;    // of the band before
  std::uint32_t first_end_ = 0;  // its first block, in the unfolder
  BlockUnfolder unfolder_;
  DecodedModel model_;
};

}  // namespace

Result<DecodedModel> decode_model(const BlockFile& file, const DecodeOptions& options) {
  return ModelDecoder(file, options).run();
}

}  // namespace crease
