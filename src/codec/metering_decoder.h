// A RangeDecoder that adds up what each stream takes: -log2 of the probability of every bit.
#pragma once

#include "codec/range_decoder.h"

#include <cmath>

namespace crease::codec {

class MeteringDecoder {
 public:
  static constexpr bool kEncodes = false;

  MeteringDecoder(std::span<const std::byte> bytes, StreamBits& bits)
      : decoder_(bytes), bits_(bits) {}

  template <class Model>
  bool bit(Model& model, bool) {
    const double one = model.probability() / double(1u << kProbabilityBits);
    const bool bit = decoder_.bit(model, false);
    add(-std::log2(bit ? one : 1 - one));
    return bit;
  }
  template <std::size_t N>
  std::uint32_t one_of(const Shares<N>& shares, std::uint32_t) {
    const std::uint32_t i = shares.find(place());
    take_share(shares.begin(i), shares.begin(i + 1));
    return i;
  }
  std::uint32_t place() const { return decoder_.place(); }
  void take_share(std::uint32_t begin, std::uint32_t end) {
    decoder_.take_share(begin, end);
    add(std::log2(kAllShares / double(end - begin)));
  }
  std::uint32_t uniform(std::uint32_t count, std::uint32_t) {
    add(std::log2(double(count)));
    return decoder_.uniform(count, 0);
  }
  std::uint32_t bits(int count, std::uint32_t) {
    add(count);
    return decoder_.bits(count, 0);
  }
  void enter(Stream stream) { stream_ = stream; }
  bool failed() const { return decoder_.failed(); }

 private:
  void add(double bits) { bits_[std::size_t(stream_)] += bits; }

  RangeDecoder decoder_;
  StreamBits& bits_;
  Stream stream_ = Stream::Roots;
};

}  // namespace crease::codec
