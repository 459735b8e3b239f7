// docs/format-block.md, "Values": codes as numbers.
#pragma once

#include "plain_decoder/block.h"
#include "plain_decoder/container.h"

#include <vector>

namespace plain {

// As many floats as the layer has dimensions. `lattices`: one a component, where it has any.
std::vector<float> value_of(const Code& code, const BlockLayer& layer,
                            const std::vector<Lattice>& lattices);

}  // namespace plain
