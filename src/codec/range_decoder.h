// Bytes to bits: the counterpart of RangeEncoder.
#pragma once

#include "codec/adaptive_bit.h"
#include "codec/shares.h"
#include "codec/stream.h"

#include <algorithm>
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
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
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
    const std::uint32_t step = range_ >> 16;
    const std::uint32_t i = shares.find(std::min(code_ / step, Shares<N>::kAll - 1));
    const std::uint32_t begin = step * shares.begin(i);
    code_ -= begin;
    range_ = shares.begin(i + 1) == Shares<N>::kAll ? range_ - begin
                                                    : step * shares.begin(i + 1) - begin;
    normalize();
    return i;
  }

  std::uint32_t uniform(std::uint32_t count, std::uint32_t) {
    const std::uint32_t step = range_ / count;
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

  // What the next bits are about; see MeteringDecoder.
  void enter(Stream) {}

  // The bytes ended so long ago that no encoder made them, or hold what none writes.
  bool failed() const { return corrupt_ || beyond_ > kSlack; }

 private:
  // What finish() writes and the zeros that it leaves out of that.
  static constexpr std::size_t kSlack = 8;

  void normalize() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
  }
  std::uint32_t next() {
    if (at_ < bytes_.size()) return std::to_integer<std::uint32_t>(bytes_[at_++]);
    ++beyond_;
    return 0;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0, beyond_ = 0;
  std::uint32_t range_ = 0xffffffffu, code_ = 0;
  bool corrupt_ = false;
};

}  // namespace crease::codec
