// One block: bytes and what it starts from in, what it ends at out.
#pragma once

#include "codec/block_coder.h"
#include "codec/block_end.h"
#include "codec/stream.h"
#include "crease/result.h"

#include <cstddef>
#include <span>

namespace crease::codec {

struct DecodedBlock {
  FineEnd end;
  std::vector<Split> splits;  // in the order in which they were coded: parents first
};

// What decoding a block of these counts takes at most, the decoded block included; bytes.
constexpr std::uint64_t decoded_bytes(const BlockLimits& limits, std::size_t layer_count) {
  return 4096 + 400 * (std::uint64_t(limits.vertices) + limits.triangles) +
         160 * std::uint64_t(layer_count) * limits.triangles;
}

// And what the decoded block takes of that, in terms of the whole model (UnfoldedBlock).
constexpr std::uint64_t kept_bytes(const BlockLimits& limits, std::size_t layer_count) {
  return 1024 + 64 * std::uint64_t(limits.vertices) + 32 * std::uint64_t(limits.triangles) +
         std::uint64_t(layer_count) * (128 + 96 * std::uint64_t(limits.triangles));
}

// `bits`, where not null, is added to: what each stream takes. That makes it slower.
// Fails, naming the block, if `bytes` are not a block. Takes no more memory than decoded_bytes() of
// `limits`.
Result<DecodedBlock> decode_block(std::span<const std::byte> bytes, std::uint32_t block,
                                  const BlockCoding& coding, const BlockLimits& limits,
                                  CoarseEnd start, StreamBits* bits = nullptr);

}  // namespace crease::codec
