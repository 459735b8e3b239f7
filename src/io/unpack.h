// .zst and .xz taken off, told by their first bytes.
#pragma once

#include "crease/result.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

enum class Packing { None, Zstd, Xz };
Packing packing_of(std::span<const std::byte> bytes);

// "city.obj.xz" -> "city.obj".
std::string_view without_packing(std::string_view name);

// Meshes pack 3 to 30 times, grids of equal heights more. Past this many times, and past
// kUnpackedAlways bytes, it is a bomb: fails with OverLimit before taking the memory.
inline constexpr std::size_t kMaxUnpackedTimes = 1000;
inline constexpr std::size_t kUnpackedAlways = std::size_t(64) << 20;

// The whole content. `packing` is not None. Memory: the result and what the decoder's window takes
// (128 MiB at most).
Result<std::vector<std::byte>> unpack(std::span<const std::byte> bytes, Packing packing,
                                      const std::string& name);

}  // namespace crease
