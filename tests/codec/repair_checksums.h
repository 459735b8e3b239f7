// Right checksums for harmed bytes, so that what looks at them is what stands behind checksums.
#pragma once

#include "base/bytes.h"
#include "codec/checksum.h"
#include "codec/container.h"
#include "codec/decode_container.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace crease {

namespace repair {

inline void put(std::vector<std::byte>& bytes, std::uint64_t at, const ByteWriter& value) {
  std::copy(value.bytes().begin(), value.bytes().end(),
            bytes.begin() + static_cast<std::ptrdiff_t>(at));
}
inline void put(std::vector<std::byte>& bytes, std::uint64_t at, std::uint64_t value) {
  ByteWriter out;
  out.u64(value);
  put(bytes, at, out);
}
inline void put(std::vector<std::byte>& bytes, std::uint64_t at, std::uint32_t value) {
  ByteWriter out;
  out.u32(value);
  put(bytes, at, out);
}

inline std::span<const std::byte> part(const std::vector<std::byte>& bytes,
                                       const FileRange& range) {
  if (range.offset > bytes.size() || range.bytes > bytes.size() - range.offset) return {};
  return std::span(bytes).subspan(static_cast<std::size_t>(range.offset),
                                  static_cast<std::size_t>(range.bytes));
}

inline void page_and_blocks(std::vector<std::byte>& bytes, const BlockFileHead& head,
                            std::uint32_t page) {
  const FileRange& range = head.pages[page];
  if (part(bytes, range).empty()) return;
  const auto decoded = decode_page(part(bytes, range), head, page, Checksums::Ignore);
  if (decoded.ok()) {
    for (const BlockEntry& entry : decoded->blocks) {
      const FileRange payload{entry.offset, entry.bytes};
      if (entry.bytes > 0 && part(bytes, payload).empty()) continue;
      const std::uint64_t i = index_of(entry.id) % kBlocksPerPage;
      put(bytes, range.offset + format::kPageHeadBytes + i * format::kPayloadChecksumBytes,
          payload_checksum(part(bytes, payload)));
    }
  }
  put(bytes, range.offset, checksum(part(bytes, range).subspan(8)));
}

// The bytes of each image before those of their list.
inline void images(std::vector<std::byte>& bytes, const BlockFileHead& head) {
  const auto list = decode_image_list(part(bytes, head.image_list.range), head);
  if (!list.ok()) return;
  std::uint64_t at = head.image_list.range.offset + 4;
  for (const ImageEntry& entry : *list) {
    at += 4 + entry.name.size() + 8;
    const auto there = part(bytes, entry.range);
    if (!there.empty()) put(bytes, at, checksum(there));
    at += 8;
  }
}

}  // namespace repair

// Of everything that is there and whose place can be told.
inline void repair_checksums(std::vector<std::byte>& bytes) {
  const auto head = decode_head(bytes, bytes.size(), Checksums::Ignore);
  if (head.ok()) {
    repair::images(bytes, *head);
    std::uint64_t at = 104;
    for (const auto* section : {&head->materials, &head->parts, &head->tables, &head->image_list}) {
      const auto there = repair::part(bytes, section->range);
      if (!there.empty()) repair::put(bytes, at, checksum(there));
      at += 16;
    }
    for (std::uint32_t p = 0; p < head->pages.size(); ++p) {
      repair::page_and_blocks(bytes, *head, p);
    }
  }
  if (bytes.size() < format::kFixedHeadBytes) return;
  const std::uint32_t head_bytes = u32_at(bytes, 12);
  if (head_bytes < format::kHeadStartBytes || head_bytes > bytes.size()) return;
  const auto start = std::span<const std::byte>(bytes);
  repair::put(bytes, 24, checksum(start.first(24), start.first(head_bytes).subspan(32)));
}

}  // namespace crease
