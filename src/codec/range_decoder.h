// Bytes to bits: the counterpart of RangeEncoder.
#pragma once

#include "codec/adaptive_bit.h"
#include "codec/shares.h"
#include "codec/stream.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease::codec {

// Any bytes decode to something. Whoever reads counts what comes out against limits, and asks
// failed(): bytes that end early are no file of ours.
class RangeDecoder {
 public:
  static constexpr bool kEncodes = false;

  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    code_ = next_four();
    at_ = 4;
  }

  // The second argument is for the encoder.
  template <class Model>
  bool bit(Model& model, bool) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * model.probability();
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    model.learn(bit);
    normalize();
    return bit;
  }

  template <std::size_t N>
  std::uint32_t one_of(const Shares<N>& shares, std::uint32_t) {
    const std::uint32_t i = shares.find(place());
    take_share(shares.begin(i), shares.begin(i + 1));
    return i;
  }
  // The same by hand: the place of what comes next, below kAllShares; then the share that it is in.
  std::uint32_t place() const { return std::min(code_ / (range_ >> 16), kAllShares - 1); }
  void take_share(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t step = range_ >> 16, before = step * begin, to = step * end;
    code_ -= before;
    range_ = (end == kAllShares ? range_ : to) - before;
    normalize();
  }

  std::uint32_t uniform(std::uint32_t count, std::uint32_t) { return take(count, range_ / count); }
  std::uint32_t bits(int count, std::uint32_t) { return take(1u << count, range_ >> count); }

  // What the next bits are about; see MeteringDecoder.
  void enter(Stream) {}

  // Bits that all until now has taken.
  double bits_taken() const { return 8.0 * double(at_) - std::log2(double(range_)); }

  // That nothing until now depends on. An encoder leaves none behind what it was given.
  std::size_t bytes_left() const { return at_ < bytes_.size() ? bytes_.size() - at_ : 0; }

  // The bytes ended so long ago that no encoder made them, or hold what none writes.
  bool failed() const { return corrupt_ || at_ > bytes_.size() + kSlack; }

 private:
  // What finish() writes and the zeros that it leaves out of that.
  static constexpr std::size_t kSlack = 8;

  // One of `count`, `step` each.
  std::uint32_t take(std::uint32_t count, std::uint32_t step) {
    std::uint32_t value = code_ / step;
    if (value >= count) {  // no encoder writes this
      value = count - 1;
      corrupt_ = true;
    }
    code_ -= step * value;
    range_ = step;
    normalize();
    return value;
  }

  // As many bytes as make the range 2^24 or more; no branch, since nobody can tell how many.
  [[gnu::always_inline]] void normalize() {
    const int bits = std::countl_zero(range_) & ~7;
    range_ <<= bits;
    code_ = code_ << bits | static_cast<std::uint32_t>(std::uint64_t(next_four()) << bits >> 32);
    at_ += static_cast<std::size_t>(bits) / 8;
  }
  std::uint32_t next_four() const {
    if (at_ + 4 <= bytes_.size()) {
      const std::byte* b = bytes_.data() + at_;
      return std::to_integer<std::uint32_t>(b[0]) << 24 |
             std::to_integer<std::uint32_t>(b[1]) << 16 |
             std::to_integer<std::uint32_t>(b[2]) << 8 | std::to_integer<std::uint32_t>(b[3]);
    }
    std::uint32_t four = 0;
    for (std::size_t i = at_; i < at_ + 4; ++i) {
      four = four << 8 | (i < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[i]) : 0);
    }
    return four;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;  // may lie beyond the end, where zeros are read
  std::uint32_t range_ = 0xffffffffu, code_ = 0;
  bool corrupt_ = false;
};

}  // namespace crease::codec
