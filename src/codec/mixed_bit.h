// One probability out of several: logistic mixing (Mahoney 2005). Each input knows the bit in a
// context of its own; the weights learn which to trust. Integers only.
//
//   MixedBit bit({&by_size, &by_valence}, weights);
//   coder.bit(bit, value);
#pragma once

#include "codec/adaptive_bit.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace crease::codec {

// 4096 / (1 + e^(-x / 256)), -2047 <= x <= 2047: between points 128 apart.
inline constexpr std::array<std::int32_t, 33> kSquashed{
    1,    2,    3,    6,    10,   16,   27,   45,   73,   120,  194,
    310,  488,  747,  1101, 1546, 2047, 2549, 2994, 3348, 3607, 3785,
    3901, 3975, 4022, 4050, 4068, 4079, 4085, 4089, 4092, 4093, 4094};

constexpr std::int32_t squash(std::int32_t x) {
  x = std::clamp(x, -2047, 2047) + 2048;
  const std::size_t point = static_cast<std::size_t>(x >> 7);
  const std::int32_t part = x & 127;
  return (kSquashed[point] * (128 - part) + kSquashed[point + 1] * part + 64) >> 7;
}

// The inverse, of a probability in 1 / 4096.
inline std::int32_t stretch(std::uint32_t probability) {
  static constexpr auto kTable = [] {
    std::array<std::int16_t, 4096> table{};
    std::size_t p = 0;
    for (std::int32_t x = -2047; x <= 2047; ++x) {
      for (; p <= static_cast<std::size_t>(squash(x)); ++p) table[p] = static_cast<std::int16_t>(x);
    }
    for (; p < table.size(); ++p) table[p] = 2047;
    return table;
  }();
  return kTable[probability];
}

template <std::size_t N>
class MixingWeights {
 public:
  MixingWeights() { weights_.fill(65536 * 2 / (static_cast<std::int32_t>(N) + 1)); }

 private:
  template <std::size_t>
  friend class MixedBit;
  std::array<std::int32_t, N> weights_;  // in 1 / 65536
};

template <std::size_t N>
class MixedBit {
 public:
  MixedBit(const std::array<AdaptiveBit*, N>& inputs, MixingWeights<N>& weights)
      : inputs_(inputs), weights_(weights) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
      stretched_[i] = stretch(inputs_[i]->probability() >> (kProbabilityBits - 12));
      sum += std::int64_t(weights_.weights_[i]) * stretched_[i];
    }
    mixed_ = squash(static_cast<std::int32_t>(std::clamp<std::int64_t>(sum >> 16, -2047, 2047)));
  }

  std::uint32_t probability() const {
    return static_cast<std::uint32_t>(std::clamp(mixed_, 1, 4095)) << (kProbabilityBits - 12);
  }

  void learn(bool bit) {
    const std::int32_t error = ((bit ? 4095 : 0) - mixed_) * kRate;
    for (std::size_t i = 0; i < N; ++i) {
      weights_.weights_[i] += (stretched_[i] * error + (1 << 13)) >> 14;
      inputs_[i]->learn(bit);
    }
  }

 private:
  static constexpr std::int32_t kRate = 14;

  std::array<AdaptiveBit*, N> inputs_;
  MixingWeights<N>& weights_;
  std::array<std::int32_t, N> stretched_{};
  std::int32_t mixed_ = 0;
};

}  // namespace crease::codec
