#include "base/assert.h"
#include "base/bytes.h"
#include "codec/container.h"
#include "codec/container_rules.h"
#include "codec/decode_container.h"
#include "codec/file_version.h"

#include <optional>
#include <utility>

namespace crease {

namespace {

LevelError decode_error_codes(ByteReader& in) {
  LevelError e;
  for (float* f : {&e.surface, &e.line, &e.degrees, &e.texture}) {
    *f = format::error_of_code(in.u16());
  }
  return e;
}

// An entry as it stands in the page, its offset and its number left to the caller.
struct DecodedEntry {
  BlockEntry entry;
  std::uint16_t reserved = 0;
  std::uint32_t dependency_end = 0;
};

DecodedEntry decode_entry(ByteReader& in) {
  DecodedEntry result;
  BlockFacts& facts = result.entry.facts;
  result.entry.checksum = in.u64();
  result.entry.bytes = in.u32();
  facts.decoded_bytes = in.u32();
  facts.band = in.u16();
  result.reserved = in.u16();
  facts.patch = in.u32();
  for (int axis = 0; axis < 3; ++axis) facts.center[axis] = static_cast<std::int32_t>(in.u32());
  facts.radius = in.u32();
  for (std::uint32_t* n :
       {&facts.splits, &facts.vertices, &facts.triangles_coarse, &facts.triangles_fine}) {
    *n = in.u32();
  }
  facts.coarse = decode_error_codes(in);
  facts.fine = decode_error_codes(in);
  result.dependency_end = in.u32();
  return result;
}

class PageDecoder {
 public:
  PageDecoder(std::span<const std::byte> bytes, const BlockFileHead& head, std::uint32_t page)
      : in_(bytes), head_(head), page_(page) {
    in_.u64();  // the checksum
  }

  Result<DirectoryPage> run() {
    const std::uint32_t number = in_.u32();
    dependency_count_ = in_.u32();
    const std::uint32_t count = format::blocks_of_page(head_.block_count, page_);
    if (number != page_) return bad("it is page " + std::to_string(number));
    if (head_.pages[page_].bytes != format::page_bytes(count, dependency_count_)) {
      return bad("its size is not that of its entries");
    }
    if (auto failure = decode_entries(count)) return *failure;
    if (auto failure = decode_dependencies()) return *failure;
    return std::move(result_);
  }

 private:
  Failure bad(const std::string& what) const {
    return fail(Error::BadFormat, page_name(head_, page_) + ": " + what);
  }
  Failure bad(BlockId id, const std::string& what) const {
    return bad("block " + std::to_string(index_of(id)) + ": " + what);
  }

  std::optional<Failure> decode_entries(std::uint32_t count) {
    const FileRange& range = head_.pages[page_];
    result_.first = BlockId{page_ * kBlocksPerPage};
    result_.blocks.reserve(count);
    result_.dependency_ends.reserve(count);
    std::uint64_t offset = range.offset + range.bytes;
    const std::uint64_t end =
        page_ + 1 < head_.pages.size() ? head_.pages[page_ + 1].offset : head_.parts.range.offset;
    std::uint32_t dependency_end = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      DecodedEntry decoded = decode_entry(in_);
      BlockEntry& entry = decoded.entry;
      entry.id = BlockId{page_ * kBlocksPerPage + i};
      entry.offset = offset;
      if (decoded.reserved != 0) return bad(entry.id, "a reserved byte is not 0");
      std::string wrong = broken_rule(entry.facts, head_.facts.bands.size());
      if (!wrong.empty()) return bad(entry.id, wrong);
      if (entry.bytes > end - offset) return bad(entry.id, "it ends where another page is");
      if (decoded.dependency_end < dependency_end || decoded.dependency_end > dependency_count_) {
        return bad(entry.id, "its dependencies are out of range");
      }
      offset += entry.bytes;
      dependency_end = decoded.dependency_end;
      result_.blocks.push_back(entry);
      result_.dependency_ends.push_back(dependency_end);
    }
    if (offset != end) return bad("its blocks do not end where the next page begins");
    if (dependency_end != dependency_count_) return bad("dependencies of no block");
    return std::nullopt;
  }

  std::optional<Failure> decode_dependencies() {
    result_.dependencies.reserve(dependency_count_);
    for (std::uint32_t i = 0; i < dependency_count_; ++i) {
      result_.dependencies.push_back(BlockId{in_.u32()});
    }
    for (const BlockEntry& entry : result_.blocks) {
      std::string wrong = broken_rule(entry.id, result_.dependencies_of(entry.id));
      if (!wrong.empty()) return bad(entry.id, wrong);
    }
    return std::nullopt;
  }

  ByteReader in_;
  const BlockFileHead& head_;
  std::uint32_t page_;
  std::uint32_t dependency_count_ = 0;
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
                                  std::uint32_t page, Checksums checksums) {
  // What decode_head() has seen to: no page is smaller than its entries.
  CREASE_ASSERT(page < head.pages.size() && bytes.size() == head.pages[page].bytes &&
                bytes.size() >= format::kPageHeadBytes);
  if (checksums == Checksums::Verify && checksum(bytes.subspan(8)) != ByteReader(bytes).u64()) {
    return fail(Error::BadChecksum, page_name(head, page) + ": checksum differs" + kBuildAgain);
  }
  return PageDecoder(bytes, head, page).run();
}

}  // namespace crease
