// What a file may say about a model and its blocks. The writer refuses what a reader would.
#pragma once

#include "crease/block_file.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace crease {

// The first rule that is broken, in words; empty: none.
std::string broken_rule(const ModelFacts& facts);
std::string broken_rule(const Material& material);
std::string broken_rule(std::vector<std::string_view> names_of_images);
std::string broken_rule(const BlockFacts& block, std::size_t band_count);
std::string broken_rule(BlockId id, std::span<const BlockId> dependencies);

}  // namespace crease
