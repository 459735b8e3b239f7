#include "codec/file_version.h"

#include "base/bytes.h"
#include "codec/container.h"

#include <algorithm>

namespace crease {

Result<std::uint16_t> decode_version(std::span<const std::byte> start) {
  if (start.empty()) return fail(Error::NotCrease, "the file is empty");
  const std::size_t known = std::min(start.size(), format::kMagic.size());
  const auto* given = reinterpret_cast<const std::uint8_t*>(start.data());
  if (!std::equal(given, given + known, format::kMagic.begin())) {
    return fail(Error::NotCrease, "its first bytes are not those of a .crease file");
  }
  ByteReader in(start);
  in.u64();  // the magic
  const std::uint16_t version = in.u16();
  const std::uint16_t flags = in.u16();
  if (in.truncated()) {
    return fail(Error::Truncated, std::string("it ends within the header") + kBuildAgain);
  }
  if (version > format::kNewestVersion) {
    return fail(Error::VersionTooNew, "version " + std::to_string(version) +
                                          " is newer than this program, which reads up to " +
                                          std::to_string(format::kNewestVersion));
  }
  if (version == 0 || flags != 0) return fail(Error::BadFormat, "version or flags at byte 8");
  return version;
}

}  // namespace crease
