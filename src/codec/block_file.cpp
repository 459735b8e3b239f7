#include "crease/block_file.h"

#include "base/assert.h"
#include "codec/checksum.h"
#include "codec/container.h"
#include "codec/decode_container.h"
#include "codec/file_version.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace crease {

namespace {

// Of memory taken to bytes read, at most (see BlockFileLimits).
constexpr std::uint64_t kBytesFactor = 1, kNamesFactor = 12;

Failure with_name(const ByteSource& source, const Failure& failure) {
  const std::string name = source.name();
  if (name.empty()) return failure;
  return fail(failure.error, name + ": " + failure.message);
}

}  // namespace

BlockFile::BlockFile(ByteSourcePtr source, const BlockFileLimits& limits, BlockFileHead head)
    : source_(std::move(source)), limits_(limits), head_(std::move(head)) {}

Failure BlockFile::named(const Failure& failure) const {
  return with_name(*source_, failure);
}

Result<BlockFile> BlockFile::open(ByteSourcePtr source, const BlockFileLimits& limits) {
  const std::uint64_t size = source->size();
  std::vector<std::byte> start(
      static_cast<std::size_t>(std::min<std::uint64_t>(size, format::kMaxHeadBytes)));
  if (Status status = source->read(0, start); !status.ok()) {
    return with_name(*source, status.failure());
  }
  Result<BlockFileHead> head = decode_head(start, size, Checksums::Verify);
  if (!head.ok()) return with_name(*source, head.failure());
  return BlockFile(std::move(source), limits, std::move(*head));
}

Result<std::vector<std::byte>> BlockFile::read_range(const FileRange& range,
                                                     const std::string& what,
                                                     std::uint64_t memory_factor) const {
  const std::uint64_t there = source_->size();
  if (range.offset > there || range.bytes > there - range.offset) {
    return named(fail(Error::Truncated, what + ": it is not there yet: the file has " +
                                            std::to_string(there) + " of " +
                                            std::to_string(head_.file_bytes) + " bytes"));
  }
  if (range.bytes > limits_.max_bytes / memory_factor) {
    return named(fail(Error::OverLimit, what + ": it takes more than the limit of " +
                                            std::to_string(limits_.max_bytes) + " bytes"));
  }
  std::vector<std::byte> bytes(static_cast<std::size_t>(range.bytes));
  if (Status status = source_->read(range.offset, bytes); !status.ok()) {
    return named(fail(status.failure().error, what + ": " + status.failure().message));
  }
  return bytes;
}

Result<DirectoryPage> BlockFile::read_page(std::uint32_t page) const {
  CREASE_ASSERT(page < page_count());
  const auto bytes = read_range(head_.pages[page], page_name(head_, page), kBytesFactor);
  if (!bytes.ok()) return bytes.failure();
  Result<DirectoryPage> decoded =
      decode_page(*bytes, head_, page, Checksums::Verify, limits_.max_bytes);
  if (!decoded.ok()) return named(decoded.failure());
  return decoded;
}

Status check_payload(const BlockEntry& entry, std::span<const std::byte> payload) {
  if (payload.size() == entry.bytes && payload_checksum(payload) == entry.checksum) return Done{};
  return fail(Error::BadChecksum, block_name(entry) + ": checksum differs" + kBuildAgain);
}

Result<std::vector<std::byte>> BlockFile::read_block(const BlockEntry& entry) const {
  auto bytes = read_range({entry.offset, entry.bytes}, block_name(entry), kBytesFactor);
  if (!bytes.ok()) return bytes;
  if (Status status = check_payload(entry, *bytes); !status.ok()) return named(status.failure());
  return bytes;
}

Result<std::vector<std::byte>> BlockFile::read_section(const BlockFileHead::Section& section,
                                                       const char* what,
                                                       std::uint64_t memory_factor) const {
  if (section.range.bytes == 0) return std::vector<std::byte>();
  const std::string name = what + at_byte(section.range.offset);
  auto bytes = read_range(section.range, name, memory_factor);
  if (!bytes.ok() || checksum(*bytes) == section.checksum) return bytes;
  return named(fail(Error::BadChecksum, name + ": checksum differs" + kBuildAgain));
}

Result<std::vector<Material>> BlockFile::read_materials() const {
  const auto bytes = read_section(head_.materials, "materials", kNamesFactor);
  if (!bytes.ok()) return bytes.failure();
  auto materials = decode_materials(*bytes, format::layout_of(head_.version));
  if (!materials.ok()) return named(materials.failure());
  return materials;
}

Result<std::vector<std::string>> BlockFile::read_parts() const {
  const auto bytes = read_section(head_.parts, "part names", kBytesFactor);
  if (!bytes.ok()) return bytes.failure();
  auto parts = decode_parts(*bytes, head_.part_count, limits_.max_bytes);
  if (!parts.ok()) return named(parts.failure());
  return parts;
}

bool BlockFile::has_parts() const {
  return source_->size() >= head_.parts.range.offset + head_.parts.range.bytes;
}

Result<std::vector<std::byte>> BlockFile::read_tables() const {
  return read_section(head_.tables, "model tables", kBytesFactor);
}

Result<std::uint32_t> BlockFile::complete_blocks() const {
  const std::uint64_t there = source_->size();
  if (there >= head_.file_bytes) return head_.block_count;
  // Pages before `page` lie before another one that begins within what is there.
  std::uint32_t page = 0;
  while (page + 1 < page_count() && head_.pages[page + 1].offset <= there) ++page;
  if (page == page_count()) return 0u;
  const FileRange& range = head_.pages[page];
  if (range.offset > there || range.bytes > there - range.offset) return page * kBlocksPerPage;
  const Result<DirectoryPage> directory = read_page(page);
  if (!directory.ok()) return directory.failure();
  std::uint32_t complete = page * kBlocksPerPage;
  for (const BlockEntry& entry : directory->blocks) {
    if (entry.offset + entry.bytes > there) break;
    ++complete;
  }
  return complete;
}

Result<std::vector<ImageEntry>> BlockFile::read_image_list() const {
  const auto bytes = read_section(head_.image_list, "list of images", kNamesFactor);
  if (!bytes.ok()) return bytes.failure();
  auto images = decode_image_list(*bytes, head_);
  if (!images.ok()) return named(images.failure());
  return images;
}

Status check_image(const ImageEntry& entry, std::span<const std::byte> bytes) {
  if (bytes.size() == entry.range.bytes && checksum(bytes) == entry.checksum) return Done{};
  return fail(Error::BadChecksum, image_name(entry) + ": checksum differs" + kBuildAgain);
}

Result<std::vector<std::byte>> BlockFile::read_image(const ImageEntry& entry) const {
  auto bytes = read_range(entry.range, image_name(entry), kBytesFactor);
  if (!bytes.ok()) return bytes;
  if (Status status = check_image(entry, *bytes); !status.ok()) return named(status.failure());
  return bytes;
}

Result<std::vector<ImageFile>> BlockFile::read_images() const {
  const Result<std::vector<ImageEntry>> entries = read_image_list();
  if (!entries.ok()) return entries.failure();
  std::vector<FileRange> ranges;
  for (const ImageEntry& entry : *entries) ranges.push_back(entry.range);
  source_->prefetch(ranges);
  std::vector<ImageFile> images;
  for (const ImageEntry& entry : *entries) {
    Result<std::vector<std::byte>> bytes = read_image(entry);
    if (!bytes.ok()) return bytes.failure();
    images.push_back(
        {entry.name, std::make_shared<const std::vector<std::byte>>(*std::move(bytes))});
  }
  return images;
}

bool BlockFile::has_images() const {
  return source_->size() >= head_.file_bytes;
}

std::vector<std::string> BlockFile::validate() const {
  std::vector<std::string> wrong;
  const auto note = [&wrong](const auto& result) {
    if (!result.ok()) wrong.push_back(result.failure().message);
  };
  note(read_materials());
  note(read_parts());
  note(read_tables());
  const Result<std::vector<ImageEntry>> images = read_image_list();
  note(images);
  if (images.ok()) {
    for (const ImageEntry& entry : *images) note(read_image(entry));
  }
  for (std::uint32_t p = 0; p < page_count(); ++p) {
    const Result<DirectoryPage> page = read_page(p);
    note(page);
    if (!page.ok()) continue;
    std::vector<FileRange> ranges;
    for (const BlockEntry& entry : page->blocks) ranges.push_back({entry.offset, entry.bytes});
    source_->prefetch(ranges);
    for (const BlockEntry& entry : page->blocks) note(read_block(entry));
  }
  return wrong;
}

}  // namespace crease
