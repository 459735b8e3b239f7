#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace crease {

enum class Checksums {
  Verify,
  Ignore,  // for fuzzing: bytes that lie about everything but their layout
};

// XXH3-64 with seed 0, of `first` followed by `second`.
std::uint64_t checksum(std::span<const std::byte> first, std::span<const std::byte> second = {});

// Its lower half, which a page has of each block.
inline std::uint32_t payload_checksum(std::span<const std::byte> payload) {
  return static_cast<std::uint32_t>(checksum(payload));
}

}  // namespace crease
