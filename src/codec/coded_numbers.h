// Numbers as adaptive bits. Every function is written once for both directions: with a RangeEncoder
// it writes `value` and returns it, with a RangeDecoder it ignores `value` and returns what was
// written.
#pragma once

#include "codec/adaptive_bit.h"

#include <array>
#include <bit>
#include <cstdint>

namespace crease::codec {

// 2^24 values at a time are as many as uniform() takes.
template <class Coder>
std::uint32_t code_index(Coder& coder, std::uint32_t count, std::uint32_t value) {
  constexpr std::uint32_t kMost = 1u << 16;
  if (count <= kMost) return coder.uniform(count, value);
  const std::uint32_t high = coder.uniform((count - 1) / kMost + 1, value / kMost);
  const std::uint32_t low = coder.uniform(kMost, value % kMost);
  return high * kMost + low;
}

// The same of 2^count.
template <class Coder>
std::uint32_t code_bits(Coder& coder, int count, std::uint32_t value) {
  if (count <= 16) return coder.bits(count, value);
  const std::uint32_t high = coder.bits(count - 16, value >> 16);
  return high << 16 | coder.bits(16, value & 0xffff);
}

// A number below 2^Bits with a model for every prefix.
template <int Bits>
struct TreeModel {
  std::array<AdaptiveBit, (1u << Bits)> bits;
};

template <class Coder, int Bits>
std::uint32_t code_tree(Coder& coder, TreeModel<Bits>& model, std::uint32_t value) {
  std::uint32_t prefix = 1;
  for (int i = Bits - 1; i >= 0; --i) {
    prefix = 2 * prefix + coder.bit(model.bits[prefix], value >> i & 1);
  }
  return prefix - (1u << Bits);
}

// Magnitudes up to 2^32 - 2: the number of bits of value + 1 in unary, then the bits below its
// first one, of which two are modelled.
using LengthModel = std::array<AdaptiveBit, 32>;                    // is it longer than this
using FirstBitsModel = std::array<std::array<AdaptiveBit, 4>, 32>;  // by length and prefix

// A model that knows about how large magnitudes are: `mean` > 0. Their distribution is taken to be
// 1 - (1 + x / 2 mean)^-3, which has long tails and needs no exp(), which machines disagree on.
inline LengthModel length_model(double mean, int seen) {
  LengthModel model;
  double before = 1;
  for (std::size_t i = 0; i < model.size(); ++i) {
    const double longer = 1 + (double(std::uint64_t(2) << i) - 1) / (2 * mean);
    const double ratio = before / longer;
    model[i] = AdaptiveBit(ratio * ratio * ratio, seen);
    before = longer;
  }
  return model;
}

struct MagnitudeModel {
  LengthModel length;
  FirstBitsModel first_bits;
};

template <class Coder>
std::uint32_t code_magnitude(Coder& coder, LengthModel& is_longer, FirstBitsModel& first_bits,
                             std::uint32_t value) {
  const int value_length = std::bit_width(value + 1) - 1;
  int length = 0;
  while (length < 31 && coder.bit(is_longer[std::size_t(length)], value_length > length)) {
    ++length;
  }
  std::uint32_t prefix = 1;
  int left = length;
  for (int i = 0; i < 2 && left > 0; ++i) {
    --left;
    prefix =
        2 * prefix + coder.bit(first_bits[std::size_t(length)][prefix], (value + 1) >> left & 1);
  }
  while (left > 0) {
    const int now = left < 16 ? left : 16;
    left -= now;
    prefix = prefix << now | coder.uniform(1u << now, (value + 1) >> left & ((1u << now) - 1));
  }
  return prefix - 1;
}

template <class Coder>
std::uint32_t code_magnitude(Coder& coder, MagnitudeModel& model, std::uint32_t value) {
  return code_magnitude(coder, model.length, model.first_bits, value);
}

struct SignedModel {
  MagnitudeModel magnitude;
  AdaptiveBit is_negative;
};

template <class Coder>
std::int32_t code_signed(Coder& coder, LengthModel& length, FirstBitsModel& first_bits,
                         AdaptiveBit& is_negative, std::int32_t value) {
  const std::uint32_t size =
      value < 0 ? 0u - static_cast<std::uint32_t>(value) : static_cast<std::uint32_t>(value);
  const std::uint32_t magnitude = code_magnitude(coder, length, first_bits, size);
  if (magnitude == 0) return 0;
  const bool negative = coder.bit(is_negative, value < 0);
  return static_cast<std::int32_t>(negative ? 0u - magnitude : magnitude);
}

template <class Coder>
std::int32_t code_signed(Coder& coder, SignedModel& model, std::int32_t value) {
  return code_signed(coder, model.magnitude.length, model.magnitude.first_bits, model.is_negative,
                     value);
}

// A number near the one that is expected, of all of 32 bits: their difference goes around.
template <class Coder>
std::uint32_t code_after(Coder& coder, SignedModel& model, std::uint32_t value,
                         std::uint32_t expected) {
  const auto difference = static_cast<std::int32_t>(value - expected);
  return expected + static_cast<std::uint32_t>(code_signed(coder, model, difference));
}

}  // namespace crease::codec
