#include "base/bytes.h"
#include "codec/container.h"
#include "codec/container_rules.h"
#include "codec/decode_container.h"
#include "codec/file_version.h"

#include <utility>

namespace crease {

Result<std::vector<ImageEntry>> decode_image_list(std::span<const std::byte> bytes,
                                                  const BlockFileHead& head) {
  std::vector<ImageEntry> images;
  if (bytes.empty()) return images;
  const auto bad = [](const std::string& what) {
    return fail(Error::BadFormat, "list of images: " + what);
  };
  ByteReader in(bytes);
  const std::uint32_t count = in.u32();
  if (count == 0 || count > in.remaining() / format::kImageEntryBytes) {
    return bad("their number is not as many as there are");
  }
  images.reserve(count);
  std::uint64_t offset = head.images.offset, left = head.images.bytes;
  for (std::uint32_t i = 0; i < count; ++i) {
    ImageEntry image;
    image.name = in.text();
    image.range = {offset, in.u64()};
    image.checksum = in.u64();
    if (image.range.bytes == 0 || image.range.bytes > left) return bad("one ends after the others");
    offset += image.range.bytes;
    left -= image.range.bytes;
    images.push_back(std::move(image));
  }
  if (in.truncated() || in.remaining() != 0) return bad("it does not end with its bytes");
  if (left != 0) return bad("bytes of no image");
  std::vector<std::string_view> names;
  for (const ImageEntry& image : images) names.push_back(image.name);
  if (std::string wrong = broken_rule(std::move(names)); !wrong.empty()) return bad(wrong);
  return images;
}

std::string image_name(const ImageEntry& entry) {
  return "image '" + entry.name + "'" + at_byte(entry.range.offset);
}

}  // namespace crease
