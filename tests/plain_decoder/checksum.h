// XXH3-64 with seed 0, from its specification (github.com/Cyan4973/xxHash, doc/xxhash_spec.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plain {

std::uint64_t checksum(const std::vector<std::byte>& bytes);

}  // namespace plain
