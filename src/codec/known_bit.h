// A bit whose probability is given.
#pragma once

#include <cstdint>

namespace crease::codec {

class KnownBit {
 public:
  // Of a one: `part` of `whole`. Even odds where there is nothing to go by, and never quite
  // certain.
  KnownBit(float part, float whole) {
    float p = whole > 0 ? part / whole * 65536 : 32768;
    if (!(p > kLeast)) p = kLeast;  // or not a number
    if (p > 65536 - kLeast) p = 65536 - kLeast;
    probability_ = static_cast<std::uint32_t>(p);
  }
  std::uint32_t probability() const { return probability_; }
  void learn(bool) {}

 private:
  static constexpr float kLeast = 24;
  std::uint32_t probability_;
};

}  // namespace crease::codec
