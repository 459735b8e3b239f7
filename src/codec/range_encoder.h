// Bits to bytes: a binary range coder with carries.
#pragma once

#include "codec/adaptive_bit.h"
#include "codec/shares.h"
#include "codec/stream.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease::codec {

// The counterpart of RangeDecoder: what one is given the other returns.
class RangeEncoder {
 public:
  static constexpr bool kEncodes = true;

  // Of an AdaptiveBit or a MixedBit.
  template <class Model>
  bool bit(Model& model, bool bit) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * model.probability();
    if (bit) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    model.learn(bit);
    normalize();
    return bit;
  }

  template <std::size_t N>
  std::uint32_t one_of(const Shares<N>& shares, std::uint32_t i) {
    take_share(shares.begin(i), shares.begin(i + 1));
    return i;
  }
  // The same by hand: see RangeDecoder.
  void take_share(std::uint32_t begin, std::uint32_t end) {
    const std::uint32_t step = range_ >> 16, before = step * begin;
    low_ += before;
    range_ = end == kAllShares ? range_ - before : step * end - before;
    normalize();
  }

  // One of `count` that are equally likely; count < 2^24.
  std::uint32_t uniform(std::uint32_t count, std::uint32_t value) {
    return take(range_ / count, value);
  }
  // The same of 2^count; count <= 16.
  std::uint32_t bits(int count, std::uint32_t value) { return take(range_ >> count, value); }

  bool failed() const { return false; }
  void enter(Stream) {}

  // Once, at the end. The decoder reads zeros beyond the end, so up to four are left out.
  std::vector<std::byte> finish() {
    for (int i = 0; i < 5; ++i) shift();
    for (int i = 0; i < 4 && !bytes_.empty() && bytes_.back() == std::byte{0}; ++i) {
      bytes_.pop_back();
    }
    return std::move(bytes_);
  }

 private:
  std::uint32_t take(std::uint32_t step, std::uint32_t value) {
    low_ += std::uint64_t(step) * value;
    range_ = step;
    normalize();
    return value;
  }

  void normalize() {
    while (range_ < (1u << 24)) {
      range_ <<= 8;
      shift();
    }
  }

  // Moves the topmost byte of low_ out. A byte 0xff may still become 0x100, so it waits.
  void shift() {
    if (low_ < 0xff000000u || low_ > 0xffffffffu) {
      const std::uint8_t carry = static_cast<std::uint8_t>(low_ >> 32);
      if (has_held_) bytes_.push_back(std::byte(std::uint8_t(held_ + carry)));
      for (; waiting_ > 0; --waiting_) bytes_.push_back(std::byte(std::uint8_t(0xff + carry)));
      held_ = static_cast<std::uint8_t>(low_ >> 24);
      has_held_ = true;
    } else {
      ++waiting_;
    }
    low_ = (low_ & 0x00ffffffu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffffu;
  std::uint8_t held_ = 0;
  bool has_held_ = false;
  std::size_t waiting_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace crease::codec
