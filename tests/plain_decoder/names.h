// docs/format.md, "Names".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plain {

// `letters`: of all names together.
std::vector<std::string> read_names(std::span<const std::byte> bytes, std::uint32_t count,
                                    std::uint64_t letters);

}  // namespace plain
