#include "base/assert.h"
#include "base/bytes.h"
#include "codec/container.h"
#include "codec/container_rules.h"
#include "codec/decode_container.h"
#include "codec/file_version.h"
#include "codec/page_coder.h"
#include "codec/range_decoder.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace crease {

namespace {

class PageDecoder {
 public:
  // `bytes` from the page's number on.
  PageDecoder(std::span<const std::byte> bytes, const BlockFileHead& head, std::uint32_t page)
      : in_(bytes), head_(head), page_(page) {}

  Result<DirectoryPage> run(std::uint64_t max_bytes) {
    const std::uint32_t number = in_.u32(), dependency_count = in_.u32();
    const std::uint32_t count = format::blocks_of_page(head_.block_count, page_);
    if (number != page_) return bad("it is page " + std::to_string(number));
    if (dependency_count > format::kMaxPageDependencies) return bad("too many dependencies");
    const std::uint64_t page_bytes = head_.pages[page_].bytes;
    if (page_bytes + 160 * std::uint64_t(count) + 16 * std::uint64_t(dependency_count) >
        max_bytes) {
      return fail(Error::OverLimit, page_name(head_, page_) + ": it takes more than the limit of " +
                                        std::to_string(max_bytes) + " bytes");
    }
    result_.first = BlockId{page_ * kBlocksPerPage};
    result_.blocks.reserve(count);
    result_.dependency_ends.reserve(count);
    // What is announced costs no memory before it is there.
    result_.dependencies.reserve(std::min<std::uint64_t>(dependency_count, 4 * page_bytes));
    if (auto failure = decode_entries(count, dependency_count)) return *failure;
    return std::move(result_);
  }

 private:
  Failure bad(const std::string& what) const {
    return fail(Error::BadFormat, page_name(head_, page_) + ": " + what);
  }
  Failure bad(BlockId id, const std::string& what) const {
    return bad("block " + std::to_string(index_of(id)) + ": " + what);
  }

  std::optional<Failure> decode_entries(std::uint32_t count, std::uint32_t dependency_count) {
    std::vector<std::uint32_t> checksums(count);
    for (std::uint32_t& checksum : checksums) checksum = in_.u32();
    codec::RangeDecoder decoder(in_.take(in_.remaining()));
    codec::PageCoder<codec::RangeDecoder> coder(decoder, head_.facts);
    const FileRange& range = head_.pages[page_];
    std::uint64_t offset = range.offset + range.bytes;
    const std::uint64_t end =
        page_ + 1 < head_.pages.size() ? head_.pages[page_ + 1].offset : head_.parts.range.offset;
    for (std::uint32_t i = 0; i < count; ++i) {
      const BlockId id{page_ * kBlocksPerPage + i};
      const codec::PageEntry coded = coder.code({});
      if (coder.failed()) return bad(id, "what no writer writes");
      std::string wrong = broken_rule(coded.facts, head_.facts.bands.size());
      if (!wrong.empty()) return bad(id, wrong);
      if (coded.bytes > end - offset) return bad(id, "it ends where another page is");
      result_.blocks.push_back({id, coded.facts, offset, coded.bytes, checksums[i]});
      offset += coded.bytes;
      if (auto failure = decode_dependencies(id, dependency_count, coder)) return failure;
    }
    if (coder.failed() || decoder.bytes_left() > 0) return bad("its entries do not end with it");
    if (offset != end) return bad("its blocks do not end where the next page begins");
    if (result_.dependencies.size() != dependency_count) {
      return bad("it has not as many dependencies as it says");
    }
    return std::nullopt;
  }

  std::optional<Failure> decode_dependencies(BlockId id, std::uint32_t most,
                                             codec::PageCoder<codec::RangeDecoder>& coder) {
    const std::uint32_t count = coder.code_dependency_count(0);
    if (count > most - result_.dependencies.size()) {
      return bad(id, "its dependencies are out of range");
    }
    for (std::uint32_t d = 0; d < count && !coder.failed(); ++d) {
      result_.dependencies.push_back(BlockId{coder.code_dependency(0)});
    }
    result_.dependency_ends.push_back(static_cast<std::uint32_t>(result_.dependencies.size()));
    if (coder.failed()) return bad(id, "what no writer writes");
    std::string wrong = broken_rule(id, result_.dependencies_of(id));
    if (!wrong.empty()) return bad(id, wrong);
    return std::nullopt;
  }

  ByteReader in_;
  const BlockFileHead& head_;
  std::uint32_t page_;
  DirectoryPage result_;
};

}  // namespace

std::string page_name(const BlockFileHead& head, std::uint32_t page) {
  return "page " + std::to_string(page) + at_byte(head.pages[page].offset);
}

std::string block_name(const BlockEntry& entry) {
  return "block " + std::to_string(index_of(entry.id)) + at_byte(entry.offset);
}

Result<DirectoryPage> decode_page(std::span<const std::byte> bytes, const BlockFileHead& head,
                                  std::uint32_t page, Checksums checksums,
                                  std::uint64_t max_bytes) {
  // What decode_head() has seen to: no page is smaller than its fixed part.
  CREASE_ASSERT(page < head.pages.size() && bytes.size() == head.pages[page].bytes &&
                bytes.size() >= format::kPageHeadBytes);
  if (checksums == Checksums::Verify && checksum(bytes.subspan(8)) != ByteReader(bytes).u64()) {
    return fail(Error::BadChecksum, page_name(head, page) + ": checksum differs" + kBuildAgain);
  }
  return PageDecoder(bytes.subspan(8), head, page).run(max_bytes);
}

}  // namespace crease
