// Where a number may be, as a mixture of distributions that each have a centre of their own, and
// the coding of where it is: by narrowing down an interval to one of up to eight parts with the
// odds that the mixture gives. Which component was right is never coded: what a number tells of
// that changes the components' weights for the next.
//
// Every component has the distribution function 1/2 + z / 2 sqrt(1 + z^2): long tails, and nothing
// that machines disagree on. Floats without fused products, as in predict_position.h; loops over
// eight, which compilers turn into instructions for four.
#pragma once

#include "base/wide.h"
#include "codec/coded_numbers.h"
#include "codec/eight_floats.h"
#include "codec/known_bit.h"
#include "codec/shares.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace crease::codec {

inline constexpr std::size_t kComponents = 8;
using PerComponent = std::array<float, kComponents>;

// What each component expects, and how far it may be off.
struct AxisMixture {
  PerComponent weight{}, center{}, inverse_scale{};
};

// Intervals of one width that follow each other from `low`, at most eight, before which the sum of
// the components' distribution functions is `below`. Endless: there are eight, and the first and
// the last have no end.
struct Parts {
  std::int64_t low = 0, width = 0;
  float below = 0;
  std::size_t count = 8;
  bool is_endless = false;
};
// One of them, and its share: from `begin` up to `end`, of 2^16.
struct Part {
  std::uint32_t index = 0, begin = 0, end = 0;
  float inner = 0;  // the sum before it, but after the first of endless ones
};
// Which one: that with this index, or in whose share a place is.
struct Which {
  std::uint32_t number = 0;
  bool is_index = false;
};

// The components that count: those of at least one in 256 of the weight, mostly two or three.
// Places are seen from a whole number near which they are likely.
class LikelyComponents {
 public:
  LikelyComponents(const AxisMixture& mixture, std::int32_t start);

  float all() const { return all_; }  // the weight of these
  // Within so much of each other all places are about as likely: what telling them apart by odds
  // would save is not worth its time. A power of two, 2^this.
  int even_bits() const {
    const float width = kEvenWidth / steepest_;
    if (!(width > 1)) return 0;
    return std::bit_width(static_cast<std::uint32_t>(width < kWidest ? width : kWidest)) - 1;
  }

  // The weighed sum of their distribution functions, each from -1 to 1, before x.
  float at(std::int64_t x) const {
    const float y = static_cast<float>(x) - 0.5f;
    float sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const float z = (y - center_[i]) * inverse_scale_[i];
      sum += weight_[i] * (z / std::sqrt(1 + z * z));
    }
    return sum;
  }
  Part part(const Parts& parts, Which which) const;
  // The same to the bit, as processors do it that have no eight at once.
  Part part_by_fours(const Parts& parts, Which which) const;

 private:
  static constexpr float kLeastShare = 1.0f / 256, kWidest = 1 << 28;
  static constexpr float kEvenWidth = 1;  // of the smallest scale

#if defined(CREASE_AVX2)
  CREASE_AVX2 Part wide_part(float low, float width, float below, std::uint32_t count,
                             bool is_endless, std::uint32_t which, bool is_index) const;
#endif

  std::size_t count_ = 0;
  float all_ = 0, steepest_ = 0;
  std::array<float, kComponents + 1> weight_, center_, inverse_scale_;
};

// Multiplies weights by how likely each component makes it that a number lies from `low` on, within
// `width`. Places are seen from `start`.
void weigh(AxisMixture& mixture, std::int32_t start, std::int64_t low, std::int64_t width);
// As part_by_fours().
void weigh_by_fours(AxisMixture& mixture, std::int32_t start, std::int64_t low, std::int64_t width);

// From which whole number on one lies, within a power of two; and the sums before both ends.
struct AxisInterval {
  std::int64_t low = 0;
  int bits = 0;
  float below = 0, above = 0;

  std::int64_t width() const { return std::int64_t(1) << bits; }
};

// Away from the start, beyond three steps, interval after interval, each twice as long as the one
// before.
template <class Coder>
void code_far(Coder& coder, const LikelyComponents& likely, bool up, std::int64_t away,
              AxisInterval& in) {
  const float all = likely.all();
  const std::int64_t step = in.width();
  for (in.bits += 2;; ++in.bits) {
    const std::int64_t near = in.width() - step;
    in.low = up ? near : -near - in.width();
    (up ? in.above : in.below) = likely.at(up ? near + in.width() : in.low);
    if (in.bits == 31) return;
    KnownBit is_here(in.above - in.below, up ? all - in.below : in.above + all);
    if (coder.bit(is_here, in.low <= away && away < in.low + in.width())) return;
    (up ? in.below : in.above) = up ? in.above : in.below;
  }
}

// One of some parts: `index`, which a decoder finds.
template <class Coder>
Part code_part(Coder& coder, const LikelyComponents& likely, const Parts& parts,
               std::int64_t index) {
  Which which;
  if constexpr (Coder::kEncodes) {
    which = {static_cast<std::uint32_t>(index), true};
  } else {
    which = {coder.place(), false};
  }
  const Part part = likely.part(parts, which);
  coder.take_share(part.begin, part.end);
  return part;
}

// `value` is coded relative to `start`, near which it is likely, about `size` away; differences go
// round at 2^32. The weights learn what the value says.
template <class Coder>
std::int32_t code_axis(Coder& coder, AxisMixture& mixture, std::int32_t start, float size,
                       std::int32_t value) {
  const std::int64_t away = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) -
                                                      static_cast<std::uint32_t>(start));
  const LikelyComponents likely(mixture, start);
  const float all = likely.all();

  // Three steps to either side, or farther away.
  constexpr float kLargest = 1e8f;
  const float cut = size > 0 ? (size < kLargest ? size : kLargest) : 0;
  AxisInterval in;
  in.bits = std::bit_width(static_cast<std::uint32_t>(cut));
  in.low = -4 * in.width();
  const Part side = code_part(coder, likely, {in.low, in.width(), -all, 8, true},
                              std::clamp<std::int64_t>((away - in.low) >> in.bits, 0, 7));
  in.low += std::int64_t(side.index) << in.bits;
  in.below = in.above = side.inner;
  if (side.index == 0 || side.index == 7) {
    in.below = side.index == 0 ? -all : side.inner;
    code_far(coder, likely, side.index == 7, away, in);
  }

  const int even = likely.even_bits();
  while (in.bits > even) {
    const int bits = std::min(3, in.bits - even);
    in.bits -= bits;
    const Part part =
        code_part(coder, likely, {in.low, in.width(), in.below, std::size_t(1) << bits, false},
                  (away - in.low) >> in.bits);
    in.low += std::int64_t(part.index) << in.bits;
    in.below = part.inner;
  }

  weigh(mixture, start, in.low, in.width());
  const std::uint32_t rest =
      in.bits == 0 ? 0 : code_bits(coder, in.bits, static_cast<std::uint32_t>(away - in.low));
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(start) +
                                   static_cast<std::uint32_t>(in.low + rest));
}

}  // namespace crease::codec
