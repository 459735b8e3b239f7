// A RangeDecoder that adds up what each stream takes: by how much the range narrows. That is a
// little less than the probabilities say, since the last of the shares has what rounding leaves.
#pragma once

#include "codec/range_decoder.h"

#include <utility>

namespace crease::codec {

class MeteringDecoder {
 public:
  static constexpr bool kEncodes = false;

  MeteringDecoder(std::span<const std::byte> bytes, StreamBits& bits)
      : decoder_(bytes), bits_(bits), taken_(decoder_.bits_taken()) {}

  template <class Model>
  bool bit(Model& model, bool) {
    const bool bit = decoder_.bit(model, false);
    count();
    return bit;
  }
  template <std::size_t N>
  std::uint32_t one_of(const Shares<N>& shares, std::uint32_t) {
    const std::uint32_t i = decoder_.one_of(shares, 0);
    count();
    return i;
  }
  std::uint32_t place() const { return decoder_.place(); }
  void take_share(std::uint32_t begin, std::uint32_t end) {
    decoder_.take_share(begin, end);
    count();
  }
  std::uint32_t uniform(std::uint32_t count_of, std::uint32_t) {
    const std::uint32_t value = decoder_.uniform(count_of, 0);
    count();
    return value;
  }
  std::uint32_t bits(int bit_count, std::uint32_t) {
    const std::uint32_t value = decoder_.bits(bit_count, 0);
    count();
    return value;
  }
  void enter(Stream stream) { stream_ = stream; }
  bool failed() const { return decoder_.failed(); }

 private:
  void count() {
    const double before = std::exchange(taken_, decoder_.bits_taken());
    bits_[std::size_t(stream_)] += taken_ - before;
  }

  RangeDecoder decoder_;
  StreamBits& bits_;
  double taken_;
  Stream stream_ = Stream::Roots;
};

}  // namespace crease::codec
