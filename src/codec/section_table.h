// The header of a file and its section table.
#pragma once

#include "codec/checksum.h"
#include "codec/format.h"
#include "crease/file.h"
#include "crease/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace crease {

struct SectionEntry {
  format::Kind kind{};
  std::uint32_t layer = 0;
  std::uint64_t offset = 0, bytes = 0, checksum = 0;

  std::string name() const;  // "positions", "layer 2 values"
};

struct SectionTable {
  std::uint16_t version = 0;
  std::vector<SectionEntry> entries;  // ascending, and together the rest of the file

  // The bytes of a section of `file`; empty if it is not there.
  std::span<const std::byte> find(std::span<const std::byte> file, format::Kind kind,
                                  std::uint32_t layer = 0) const;
};

Result<SectionTable> decode_section_table(std::span<const std::byte> file,
                                          const DecodeLimits& limits, Checksums checksums);

// Empty where the checksum of `entry` is right.
std::string checksum_failure(std::span<const std::byte> file, const SectionEntry& entry);

}  // namespace crease
