#include "codec/section_table.h"

#include "base/bytes.h"
#include "codec/file_version.h"

#include <algorithm>
#include <utility>

namespace crease {

namespace {

Result<SectionTable> decode_entries(ByteReader& in, std::uint32_t count, std::uint64_t file_bytes) {
  SectionTable table;
  table.version = format::kVersion;
  std::uint64_t offset = format::kHeaderBytes + std::uint64_t(count) * format::kEntryBytes;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string where = "section " + std::to_string(i) + at_byte(in.offset());
    const std::uint32_t kind = in.u32();
    SectionEntry entry;
    entry.layer = in.u32();
    entry.offset = in.u64();
    entry.bytes = in.u64();
    entry.checksum = in.u64();
    const format::KindRow* row = format::find_kind(kind);
    if (row == nullptr) return fail(Error::BadFormat, where + ": unknown kind");
    entry.kind = row->kind;
    if (!format::is_of_layer(entry.kind) && entry.layer != 0) {
      return fail(Error::BadFormat, where + ": a layer where there is none");
    }
    if (!table.entries.empty() &&
        std::pair(table.entries.back().kind, table.entries.back().layer) >=
            std::pair(entry.kind, entry.layer)) {
      return fail(Error::BadFormat, where + ": out of order");
    }
    if (entry.offset != offset || entry.bytes > file_bytes - offset || entry.bytes == 0) {
      return fail(Error::BadFormat, where + ": not where the one before ends");
    }
    if (row->item_bytes != 0 && entry.bytes % row->item_bytes != 0) {
      return fail(Error::BadFormat, where + ": not a whole number of items");
    }
    offset += entry.bytes;
    table.entries.push_back(entry);
  }
  if (offset != file_bytes) {
    return fail(Error::BadFormat, "bytes after the last section" + at_byte(offset));
  }
  return table;
}

}  // namespace

std::string SectionEntry::name() const {
  const std::string name = format::find_kind(static_cast<std::uint32_t>(kind))->name;
  if (!format::is_of_layer(kind)) return name;
  return "layer " + std::to_string(layer) + name.substr(5);
}

std::span<const std::byte> SectionTable::find(std::span<const std::byte> file, format::Kind kind,
                                              std::uint32_t layer) const {
  const auto at = std::find_if(entries.begin(), entries.end(), [&](const SectionEntry& e) {
    return e.kind == kind && e.layer == layer;
  });
  if (at == entries.end()) return {};
  return file.subspan(static_cast<std::size_t>(at->offset), static_cast<std::size_t>(at->bytes));
}

Result<SectionTable> decode_section_table(std::span<const std::byte> file,
                                          const DecodeLimits& limits, Checksums checksums) {
  const Result<std::uint16_t> version = decode_version(file);
  if (!version.ok()) return version.failure();
  if (*version != format::kVersion) {
    return fail(Error::NotSupported, "version " + std::to_string(*version) +
                                         " holds blocks, which are not read as arrays");
  }
  ByteReader in(file);
  in.u64();  // the magic
  in.u32();  // version and flags
  const std::uint32_t count = in.u32();
  const std::uint64_t file_bytes = in.u64();
  const std::uint64_t header_checksum = in.u64();
  if (in.truncated()) {
    return fail(Error::Truncated, std::string("it ends within the header") + kBuildAgain);
  }
  if (file_bytes > limits.max_bytes) {
    return fail(Error::OverLimit, "it says that it has " + std::to_string(file_bytes) +
                                      " bytes, more than the limit of " +
                                      std::to_string(limits.max_bytes));
  }
  if (count > in.remaining() / format::kEntryBytes) {
    return fail(Error::Truncated, std::string("it ends within the section table") + kBuildAgain);
  }
  const auto table_bytes = file.subspan(format::kHeaderBytes, count * format::kEntryBytes);
  if (checksums == Checksums::Verify &&
      checksum(file.first(format::kChecksumOffset), table_bytes) != header_checksum) {
    return fail(Error::BadChecksum,
                std::string("header and section table: checksum differs") + kBuildAgain);
  }
  if (file_bytes != file.size()) {
    return fail(Error::Truncated, "it has " + std::to_string(file.size()) + " bytes instead of " +
                                      std::to_string(file_bytes) + kBuildAgain);
  }
  return decode_entries(in, count, file_bytes);
}

std::string checksum_failure(std::span<const std::byte> file, const SectionEntry& entry) {
  const auto bytes =
      file.subspan(static_cast<std::size_t>(entry.offset), static_cast<std::size_t>(entry.bytes));
  if (checksum(bytes) == entry.checksum) return {};
  return "section '" + entry.name() + "'" + at_byte(entry.offset) + ": checksum differs" +
         kBuildAgain;
}

}  // namespace crease
