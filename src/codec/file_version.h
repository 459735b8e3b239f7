// The first twelve bytes, which are the same in every version, and words that all messages share.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace crease {

inline constexpr const char* kBuildAgain = "; the file was cut or changed, build it again";

inline std::string at_byte(std::uint64_t offset) {
  return " at byte " + std::to_string(offset);
}

// Of the first bytes of a file: 1 up to the newest version that this program reads.
Result<std::uint16_t> decode_version(std::span<const std::byte> start);

}  // namespace crease
