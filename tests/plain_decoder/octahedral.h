// docs/format-block.md, "Octahedral codes".
#pragma once

#include "plain_decoder/arithmetic.h"

#include <array>
#include <cstdint>

namespace plain {

// What a corner carries in a layer. Two are one attribute iff they are equal.
using Code = std::array<std::int32_t, 4>;

class Octahedral {
 public:
  struct Flat {  // a point of the plane
    std::int32_t x = 0, y = 0;
  };
  struct Frame {
    Flat point;
    bool flipped = false;
    int turns = 0;
  };

  explicit Octahedral(int bits) : m_(((1 << (bits - 1)) - 1) / 6 * 6) {}

  FloatVector direction(const Code& code) const;
  Code rough(const FloatVector& d) const;
  Frame frame(const Code& code) const;
  std::array<float, 2> near(const FloatVector& d, const Frame& frame) const;
  Code restore(std::int32_t x, std::int32_t y, const Frame& frame) const;
  std::int32_t most() const { return 2 * m_; }  // of a component of a code

 private:
  Flat point(const Code& code) const { return {code[0] - m_, code[1] - m_}; }
  Code code(Flat p) const { return {p.x + m_, p.y + m_, 0, 0}; }
  Flat fold(Flat p) const;
  Point vector(Flat p) const;
  Flat settle(Flat p) const;
  std::array<float, 2> on_plane(const FloatVector& d, float S, bool flipped) const;
  std::int32_t brought_round(std::int64_t x) const;

  std::int32_t m_;
};

}  // namespace plain
