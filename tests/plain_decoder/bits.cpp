#include "plain_decoder/bits.h"

#include "plain_decoder/arithmetic.h"
#include "plain_decoder/tables.h"

namespace plain {

// The range decoder.

RangeDecoder::RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) code_ = 256 * code_ + next();
}

std::uint32_t RangeDecoder::next() {
  if (at_ < bytes_.size()) return std::to_integer<std::uint32_t>(bytes_[at_++]);
  ++beyond_;
  demand(beyond_ <= 8, "the bytes end too early");
  return 0;
}

void RangeDecoder::fill() {
  while (range_ < (1u << 24)) {
    range_ = 256 * range_;
    code_ = 256 * code_ + next();
  }
}

bool RangeDecoder::bit(std::uint32_t p) {
  const std::uint32_t bound = (range_ >> 16) * p;
  const bool one = code_ < bound;
  if (one) {
    range_ = bound;
  } else {
    code_ -= bound;
    range_ -= bound;
  }
  fill();
  return one;
}

std::uint32_t RangeDecoder::uniform(std::uint32_t n) {
  const std::uint32_t step = range_ / n, number = code_ / step;
  demand(number < n, "a number that no encoder writes");
  code_ -= number * step;
  range_ = step;
  fill();
  return number;
}

std::uint32_t RangeDecoder::index(std::size_t n) {
  demand(n > 0, "one of nothing");
  if (n <= 65'536) return uniform(static_cast<std::uint32_t>(n));
  const std::size_t high = uniform(static_cast<std::uint32_t>((n - 1) / 65'536 + 1));
  const std::size_t number = 65'536 * high + uniform(65'536);
  demand(number < n, "an index out of range");
  return static_cast<std::uint32_t>(number);
}

std::size_t RangeDecoder::one_of(const std::vector<float>& sums, float before, std::size_t most) {
  const std::size_t n = sums.size();
  const std::uint32_t free = static_cast<std::uint32_t>(65'536 - 8 * most);
  const float whole = sums.back() - before;
  std::vector<std::uint32_t> begin{0};
  float greatest = 0;
  for (std::size_t k = 1; k < n; ++k) {
    if (whole > 0) {
      greatest = std::max(greatest, (sums[k - 1] - before) * (static_cast<float>(free) / whole));
      const float e = std::min(greatest, static_cast<float>(free));
      begin.push_back(static_cast<std::uint32_t>(e) + static_cast<std::uint32_t>(8 * k));
    } else {
      begin.push_back(static_cast<std::uint32_t>(k * (65'536 / n)));
    }
  }
  begin.push_back(65'536);
  const std::uint32_t step = range_ >> 16, at = std::min(code_ / step, 65'535u);
  std::size_t k = 0;
  while (begin[k + 1] <= at) ++k;
  code_ -= step * begin[k];
  range_ = k + 1 == n ? range_ - step * begin[k] : step * (begin[k + 1] - begin[k]);
  fill();
  return k;
}

bool RangeDecoder::known(float part, float whole) {
  float p = whole > 0 ? part / whole * 65'536 : 32'768;
  if (!(p > 24)) p = 24;
  if (p > 65'512) p = 65'512;
  return bit(static_cast<std::uint32_t>(p));
}

// Adaptive bit.

bool AdaptiveBit::read(RangeDecoder& in) {
  const bool bit = in.bit(static_cast<std::uint32_t>(p_));
  learn(bit);
  return bit;
}

void AdaptiveBit::learn(bool bit) {
  const std::int32_t target = bit ? 65'487 : 48, r = 131'072 / (2 * n_ + 3);
  p_ += (target - p_) * r >> 16;
  if (n_ < 160) ++n_;
}

// Magnitude, signed, tree.

std::uint32_t Magnitude::read(RangeDecoder& in) {
  std::size_t length = 0;
  while (length < 31 && is_longer_[length].read(in)) ++length;
  std::uint32_t number = 1;  // its bits so far
  std::size_t left = length;
  for (int i = 0; i < 2 && left > 0; ++i, --left) {
    number = 2 * number + first_bits_[{length, number}].read(in);
  }
  while (left > 0) {
    const std::size_t k = left < 16 ? left : 16;
    number = (number << k) + in.uniform(1u << k);
    left -= k;
  }
  return number - 1;
}

std::int32_t Signed::read(RangeDecoder& in) {
  const std::uint32_t size = magnitude_.read(in);
  const bool negative = size != 0 && is_negative_.read(in);
  return static_cast<std::int32_t>(negative ? 0u - size : size);
}

std::uint32_t Tree::read(RangeDecoder& in) {
  std::uint32_t number = 1;
  for (int i = 0; i < 6; ++i) number = 2 * number + bits_[number].read(in);
  return number - 64;
}

// Mixed bit.

namespace {

std::int32_t squash(std::int32_t x) {
  const std::int32_t y = x + 2048, f = y & 127;
  const std::size_t i = static_cast<std::size_t>(y >> 7);
  return (kSquash[i] * (128 - f) + kSquash[i + 1] * f + 64) >> 7;
}

std::int32_t stretch(std::int32_t p) {
  static const std::vector<std::int32_t> table = [] {
    std::vector<std::int32_t> least;
    std::int32_t x = -2047;
    for (std::int32_t of = 0; of < 4096; ++of) {
      while (x < 2047 && squash(x) < of) ++x;
      least.push_back(x);
    }
    return least;
  }();
  return table[static_cast<std::size_t>(p)];
}

}  // namespace

bool read_mixed(RangeDecoder& in, const std::vector<AdaptiveBit*>& bits, Weights& weights) {
  const std::size_t n = bits.size();
  if (weights.empty()) weights.assign(n, 131'072 / (static_cast<std::int32_t>(n) + 1));
  std::vector<std::int32_t> s;
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    s.push_back(stretch(bits[i]->p() >> 4));
    sum += std::int64_t(weights[i]) * s[i];
  }
  const std::int64_t x = std::clamp<std::int64_t>(sum >> 16, -2047, 2047);
  const std::int32_t m = squash(static_cast<std::int32_t>(x));
  const bool bit = in.bit(static_cast<std::uint32_t>(16 * std::clamp(m, 1, 4095)));
  const std::int32_t e = 14 * ((bit ? 4095 : 0) - m);
  for (std::size_t i = 0; i < n; ++i) {
    weights[i] += (s[i] * e + 8192) >> 14;
    bits[i]->learn(bit);
  }
  return bit;
}

}  // namespace plain
