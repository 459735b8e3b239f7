// docs/format-block.md, "Positions": how a parent stood between its children.
#pragma once

#include "plain_decoder/arithmetic.h"
#include "plain_decoder/bits.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace plain {

struct Between {
  std::int64_t eighths = 4;
  std::size_t axis = 2;
};

class BetweenModel {
 public:
  BetweenModel();

  bool read_is_between(RangeDecoder& in) { return is_between_.read(in); }
  // f and g: the lengths of the first and of the second child's middle. `normal`: along the axes.
  Between read(RangeDecoder& in, float f, float g, const std::array<float, 3>& normal);

 private:
  std::int64_t read_eighths(RangeDecoder& in, float f, float g);
  std::size_t read_axis(RangeDecoder& in, const std::array<float, 3>& normal);

  AdaptiveBit is_between_{0.75, 10};
  std::array<AdaptiveBit, 4> in_middle_, to_nearer_, third_axis_;
  std::array<std::array<AdaptiveBit, 4>, 2> is_one_, is_two_;
  std::array<AdaptiveBit, 2> second_axis_;
};

// The first child along an axis, when the second is at b there and the quotient has to be `whole`.
std::int32_t read_other(RangeDecoder& in, std::int32_t b, std::int64_t whole, std::int64_t eighths);

std::int64_t step_of(std::int64_t apart_1, std::int64_t apart_2);

}  // namespace plain
