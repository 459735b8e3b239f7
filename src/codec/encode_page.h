// One page of the directory to bytes.
#pragma once

#include "crease/block_file.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace crease {

// As a file can say it: errors and the sphere rounded up, the sphere around all of what it was.
// None where that is too large. The facts hold broken_rule().
std::optional<BlockFacts> rounded_up(const BlockFacts& facts);

// Of rounded facts. `number`: of the page.
std::vector<std::byte> encode_page(const DirectoryPage& page, std::uint32_t number,
                                   const ModelFacts& model);

}  // namespace crease
