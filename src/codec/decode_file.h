#pragma once

#include "codec/section_table.h"
#include "crease/file.h"

namespace crease {

// decode_crease() with a choice.
Result<CreaseFile> decode_file(std::span<const std::byte> bytes, const DecodeLimits& limits,
                               Checksums checksums);

}  // namespace crease
