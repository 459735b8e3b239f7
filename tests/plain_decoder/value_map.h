// docs/format-block.md, "New code": what the codes around a corner let expect.
#pragma once

#include "plain_decoder/arithmetic.h"
#include "plain_decoder/block.h"

#include <vector>

namespace plain {

struct Sample {
  FloatVector place;  // from the vertex
  Code code;
};

constexpr std::size_t kDoubts = 16;

struct Expected {
  Code code{};
  std::size_t doubt = 0;
};

Expected expected_by_map(const std::vector<Sample>& samples, const FloatVector& normal,
                         std::size_t numbers);

}  // namespace plain
