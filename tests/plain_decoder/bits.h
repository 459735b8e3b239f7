// docs/format-block.md, "Bits": a range decoder and the models of bits and numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace plain {

class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::byte> bytes);

  bool bit(std::uint32_t p);               // p: probability of a one, in 1 / 65,536
  std::uint32_t uniform(std::uint32_t n);  // n at most 65,536
  std::uint32_t index(std::size_t n);
  // "Known bit".
  bool known(float part, float whole);
  // "One of" as many as there are sums, from `before` on, out of 8 or 16.
  std::size_t one_of(const std::vector<float>& sums, float before, std::size_t most);
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  std::uint32_t next();
  void fill();

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0, beyond_ = 0;
  std::uint32_t range_ = 0xffffffffu, code_ = 0;
};

class AdaptiveBit {
 public:
  AdaptiveBit() = default;
  // "Starts at q as after m".
  AdaptiveBit(double q, int m) : p_(static_cast<std::int32_t>(48 + q * 65'439)), n_(m) {}

  bool read(RangeDecoder& in);
  std::int32_t p() const { return p_; }
  void learn(bool bit);

 private:
  std::int32_t p_ = 32'768;
  std::int32_t n_ = 0;
};

// "One for each of (a, b, ...)".
template <std::size_t N>
using BitsBy = std::map<std::array<std::size_t, N>, AdaptiveBit>;

class Magnitude {
 public:
  std::uint32_t read(RangeDecoder& in);

 private:
  std::array<AdaptiveBit, 31> is_longer_;
  BitsBy<2> first_bits_;  // by length, and the bits before
};

class Signed {
 public:
  std::int32_t read(RangeDecoder& in);

 private:
  Magnitude magnitude_;
  AdaptiveBit is_negative_;
};

class Tree {
 public:
  std::uint32_t read(RangeDecoder& in);

 private:
  std::array<AdaptiveBit, 64> bits_;
};

// The weights of a mixed bit. Empty at first, which means equal.
using Weights = std::vector<std::int32_t>;
bool read_mixed(RangeDecoder& in, const std::vector<AdaptiveBit*>& bits, Weights& weights);

}  // namespace plain
