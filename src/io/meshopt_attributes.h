// The streams of attributes of KHR_meshopt_compression that meshoptimizer before 0.23 does not
// know: version 1, and the filter of colours.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace crease {

// Decodes `count` elements of `stride` bytes (a multiple of 4, 256 at most) out of a stream of
// version 0 or 1. Nothing if it is none. The caller holds `count` against the stream's size.
// Time O(count * stride).
std::optional<std::vector<std::byte>> decode_meshopt_attributes(std::span<const std::byte> stream,
                                                                std::size_t count,
                                                                std::size_t stride);

// Luma and chroma to red, green, blue and alpha, in place: four components of `stride` / 4 bytes
// each, 4 or 8 a colour.
void decode_meshopt_colors(std::span<std::byte> bytes, std::size_t stride);

}  // namespace crease
