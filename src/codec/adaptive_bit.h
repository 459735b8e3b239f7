// The probability of a bit, learned from the bits before.
#pragma once

#include <array>
#include <cstdint>

namespace crease::codec {

inline constexpr std::uint32_t kProbabilityBits = 16;

// Starts even and averages what it has seen; from kSlowest bits on, the last ones count more.
class AdaptiveBit {
 public:
  AdaptiveBit() = default;
  // Known beforehand, as well as `seen` bits would have told; 0 < p < 1.
  AdaptiveBit(double p, int seen)
      : probability_(static_cast<std::uint16_t>(kLeast + p * (65535 - 2 * kLeast))),
        seen_(static_cast<std::uint8_t>(seen)) {}

  // Of a one, in 1 / 2^16; never 0 or 1.
  std::uint32_t probability() const { return probability_; }

  void learn(bool bit) {
    const std::int32_t target = bit ? 65535 - kLeast : kLeast;
    const std::int32_t away = target - std::int32_t(probability_);
    probability_ = static_cast<std::uint16_t>(probability_ + ((away * kRates[seen_]) >> 16));
    seen_ = static_cast<std::uint8_t>(seen_ + (seen_ < kSlowest));
  }

 private:
  static constexpr int kSlowest = 160;
  static constexpr std::int32_t kLeast = 48;
  static constexpr auto kRates = [] {
    std::array<std::int32_t, kSlowest + 1> rates{};
    for (int n = 0; n <= kSlowest; ++n) rates[std::size_t(n)] = 65536 * 2 / (2 * n + 3);
    return rates;
  }();

  std::uint16_t probability_ = 1u << (kProbabilityBits - 1);
  std::uint8_t seen_ = 0;
};

}  // namespace crease::codec
