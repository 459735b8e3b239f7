#include "crease/decode_model.h"

#include "codec/model_of_blocks.h"
#include "codec/model_schema.h"
#include "codec/unfold_blocks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace crease {

namespace {

using codec::bad_block;
using codec::BlockUnfolder;
using codec::CoarseEnd;
using codec::DecodedBlock;
using codec::FineEnd;

// A block that will be decoded.
struct Chosen {
  BlockEntry entry;
  std::vector<BlockId> dependencies;
};

StreamBits named(const codec::StreamBits& bits) {
  const auto of = [&bits](codec::Stream stream) { return bits[std::size_t(stream)]; };
  return {of(codec::Stream::Roots),     of(codec::Stream::Flags),      of(codec::Stream::Shapes),
          of(codec::Stream::Positions), of(codec::Stream::Categories), of(codec::Stream::Values),
          of(codec::Stream::Labels)};
}

void one_after_the_other(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

class ModelDecoder {
 public:
  ModelDecoder(const BlockFile& file, const DecodeOptions& options)
      : file_(file),
        options_(options),
        facts_(file.facts()),
        for_each_(options.for_each ? options.for_each : one_after_the_other) {}

  Result<DecodedModel> run() {
    Result<codec::ModelSchema> schema = codec::read_schema(file_);
    if (!schema.ok()) return schema.failure();
    schema_ = *std::move(schema);
    if (options_.part_names && file_.has_parts()) {  // a model of a file that was cut has no parts
      Result<std::vector<std::string>> parts = file_.read_parts();
      if (!parts.ok()) return parts.failure();
      schema_.parts = *std::move(parts);
    }
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
    add_error(all, is_needed);
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!is_needed[i]) continue;
      const BlockFacts& facts = all[i].entry.facts;
      const codec::BlockLimits limits{facts.vertices, facts.triangles_fine};
      if (codec::decoded_bytes(limits, facts_.layers.size()) > facts.decoded_bytes) {
        return bad_block(all[i].entry.id, "it takes more memory than it says");
      }
      bytes += codec::kept_bytes(limits, facts_.layers.size());
      if (bytes > options_.max_bytes) {
        return fail(Error::OverLimit, "block " + std::to_string(i) +
                                          ": decoded blocks take more than " +
                                          std::to_string(options_.max_bytes) + " bytes");
      }
      chosen_.push_back(std::move(all[i]));
    }
    return Done{};
  }

  // What the blocks that would go on from those decoded say of their coarse ends.
  void add_error(const std::vector<Chosen>& all, const std::vector<char>& is_needed) {
    if (options_.finest_band > 0 && !facts_.bands.empty()) {
      const std::size_t finer = std::min<std::size_t>(options_.finest_band, facts_.bands.size());
      model_.error = facts_.bands[finer - 1].error;
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::vector<BlockId>& needed = all[i].dependencies;
      const bool goes_on =
          needed.empty() || std::any_of(needed.begin(), needed.end(),
                                        [&](BlockId id) { return is_needed[index_of(id)] != 0; });
      if (!is_needed[i] && goes_on) {
        model_.error = larger(model_.error, all[i].entry.facts.coarse);
      }
    }
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
        if (facts.band > band_before)
          return bad_block(entry.id, "it is not behind the coarser ones");
        band_before = facts.band;
        if (facts.patch != blocks_of_band[facts.band]++)
          return bad_block(entry.id, "not the next patch");
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
    if (starts_.empty()) starts_.resize(patches_of(band));
    std::vector<Result<DecodedBlock>> decoded(end - begin, fail(Error::BadFormat, ""));
    std::vector<codec::StreamBits> bits(end - begin, codec::StreamBits{});
    std::vector<BlockUnfolder::Start> unfolded(end - begin);
    const auto decode = [&](std::size_t i) {
      const BlockEntry& entry = chosen_[begin + i].entry;
      CoarseEnd& start = starts_[band == facts_.bands.size() ? 0 : entry.facts.patch];
      unfolded[i].names = start.names;
      unfolded[i].sources = std::move(start.sources);
      decoded[i] = decode_one(entry, std::move(start), options_.count_bits ? &bits[i] : nullptr);
    };
    for_each_(decoded.size(), decode);

    std::vector<const FineEnd*> ends;
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      if (!decoded[i].ok()) return decoded[i].failure();
      ends.push_back(&decoded[i]->end);
    }
    starts_.clear();
    if (end < chosen_.size()) {
      starts_ = codec::sort_by_label(ends, patches_of(chosen_[end].entry.facts.band));
    }
    const std::uint32_t first = static_cast<std::uint32_t>(unfolder_.blocks().size());
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      const BlockEntry& entry = chosen_[begin + i].entry;
      if (options_.count_bits) model_.bits[band] += named(bits[i]);
      model_.blocks.push_back(entry.id);
      model_.payload_bytes += entry.bytes;
      for (codec::TriangleSource& source : unfolded[i].sources) source.end += first_end_;
      unfolder_.add(entry, *std::move(decoded[i]), unfolded[i]);
    }
    first_end_ = first;
    return Done{};
  }

  std::uint32_t patches_of(std::uint16_t band) const {
    return band == facts_.bands.size() ? 1 : facts_.bands[band].patches;
  }

  Result<DecodedBlock> decode_one(const BlockEntry& entry, CoarseEnd start,
                                  codec::StreamBits* bits) const {
    const Result<std::vector<std::byte>> payload = file_.read_block(entry);
    if (!payload.ok()) return payload.failure();
    const std::size_t names = start.names.size();
    Result<DecodedBlock> block =
        codec::decode_block_of(schema_, entry, *payload, std::move(start), bits);
    if (!block.ok()) return block.failure();
    for (std::size_t v = names; v < block->end.names.size(); ++v) {
      const codec::VertexName& name = block->end.names[v];
      if (name.block != index_of(entry.id) && !unfolder_.has(name)) {
        return bad_block(entry.id, "it names a vertex that no coarser block has");
      }
    }
    return block;
  }

  Result<DecodedModel> finish() {
    codec::ModelOfBlocks(schema_, unfolder_).fill(model_, options_.contracted_bands, for_each_);
    if (Status status = check_mesh(model_.mesh); !status.ok()) {
      return fail(Error::BadFormat, "decoded mesh: " + status.failure().message);
    }
    for (const std::vector<float>& values : model_.sequence.new_values) {
      for (const float value : values) {
        if (!std::isfinite(value)) {
          return fail(Error::BadFormat, "decoded model: a value of its levels is not finite");
        }
      }
    }
    return std::move(model_);
  }

  const BlockFile& file_;
  const DecodeOptions& options_;
  const ModelFacts& facts_;
  const codec::ForEach for_each_;
  codec::ModelSchema schema_;
  std::vector<Chosen> chosen_;
  std::vector<CoarseEnd> starts_;  // of the next band's patches, out of the band before
  std::uint32_t first_end_ = 0;    // the first block of that one, in the unfolder
  BlockUnfolder unfolder_;
  DecodedModel model_;
};

}  // namespace

Result<DecodedModel> decode_model(const BlockFile& file, const DecodeOptions& options) {
  return ModelDecoder(file, options).run();
}

}  // namespace crease
