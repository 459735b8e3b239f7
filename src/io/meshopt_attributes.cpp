// Appendices A and B of the extension. A stream is blocks of elements, then the tail: the element
// before the first and, in version 1, a mode for each channel, which is four bytes of an element.
// A block has for each byte of an element the differences of its elements, in groups of 16.
#include "io/meshopt_attributes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace crease {

namespace {

constexpr std::size_t kGroup = 16;
constexpr std::size_t kMaxBlockElements = 256, kMaxBlockBytes = 8192;

// Bits a difference, by the two bits that a group has in the header.
using Widths = std::array<unsigned, 4>;
constexpr Widths kWidthsOfVersion0 = {0, 2, 4, 8};
constexpr std::array<Widths, 2> kWidthsOfControl = {{{0, 1, 2, 4}, {1, 2, 4, 8}}};

enum Control : unsigned { kZeros = 2, kAsTheyAre = 3 };  // below: packed

template <typename T>
T from_zigzag(T x) {
  return static_cast<T>((x & 1) != 0 ? ~(x >> 1) : x >> 1);
}

class AttributeDecoder {
 public:
  AttributeDecoder(std::span<const std::byte> stream, std::size_t stride)
      : stream_(stream), stride_(stride) {}

  std::optional<std::vector<std::byte>> decode(std::size_t count) {
    if (!read_tail()) return std::nullopt;
    std::vector<std::byte> elements(count * stride_);
    const std::size_t most =
        std::min(kMaxBlockBytes / stride_ / kGroup * kGroup, kMaxBlockElements);
    for (std::size_t done = 0; done < count;) {
      const std::size_t in_block = std::min(most, count - done);
      if (!read_block(std::span(elements).subspan(done * stride_, in_block * stride_))) {
        return std::nullopt;
      }
      done += in_block;
    }
    if (at_ != end_) return std::nullopt;
    return elements;
  }

 private:
  bool read_tail() {
    if (stream_.empty()) return false;
    const auto header = std::to_integer<unsigned>(stream_[0]);
    if (header != 0xa0 && header != 0xa1) return false;
    has_modes_ = header == 0xa1;
    const std::size_t mode_bytes = has_modes_ ? stride_ / 4 : 0;
    const std::size_t tail = stride_ + mode_bytes;
    const std::size_t padded = std::max<std::size_t>(tail, has_modes_ ? 24 : 32);
    if (stream_.size() < 1 + padded) return false;
    at_ = 1;
    end_ = stream_.size() - padded;
    const auto last = stream_.last(tail);
    previous_.assign(last.begin(), last.begin() + static_cast<std::ptrdiff_t>(stride_));
    modes_ = last.last(mode_bytes);
    return true;
  }

  bool read_block(std::span<std::byte> elements) {
    const std::size_t count = elements.size() / stride_;
    const std::size_t padded = (count + kGroup - 1) / kGroup * kGroup;
    std::span<const std::byte> controls;
    if (has_modes_ && !take(stride_ / 4, controls)) return false;
    for (std::size_t channel = 0; channel < stride_ / 4; ++channel) {
      std::array<std::array<std::uint8_t, kMaxBlockElements>, 4> differences;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto to = std::span(differences[k]).first(padded);
        const bool is_read =
            has_modes_
                ? read_bytes(std::to_integer<unsigned>(controls[channel]) >> (2 * k) & 3, to, count)
                : read_groups(kWidthsOfVersion0, to);
        if (!is_read) return false;
      }
      const unsigned mode = has_modes_ ? std::to_integer<unsigned>(modes_[channel]) : 0;
      if (mode > 1 && (mode & 15) != 2) return false;
      for (std::size_t i = 0; i < count; ++i) {
        add(mode, {differences[0][i], differences[1][i], differences[2][i], differences[3][i]},
            &previous_[4 * channel]);
        std::memcpy(&elements[i * stride_ + 4 * channel], &previous_[4 * channel], 4);
      }
    }
    return true;
  }

  bool read_bytes(unsigned control, std::span<std::uint8_t> to, std::size_t count) {
    if (control < kWidthsOfControl.size()) return read_groups(kWidthsOfControl[control], to);
    std::ranges::fill(to, std::uint8_t(0));
    std::span<const std::byte> bytes;
    if (control == kAsTheyAre && !take(count, bytes)) return false;
    std::ranges::transform(bytes, to.begin(), [](std::byte b) { return std::uint8_t(b); });
    return true;
  }

  bool read_groups(const Widths& widths, std::span<std::uint8_t> to) {
    const std::size_t groups = to.size() / kGroup;
    std::span<const std::byte> header;
    if (!take((groups + 3) / 4, header)) return false;
    for (std::size_t g = 0; g < groups; ++g) {
      const unsigned width = widths[std::to_integer<unsigned>(header[g / 4]) >> (2 * (g % 4)) & 3];
      if (!read_group(width, to.subspan(g * kGroup, kGroup))) return false;
    }
    return true;
  }

  // A difference of ones alone stands behind the group.
  bool read_group(unsigned width, std::span<std::uint8_t> to) {
    std::span<const std::byte> packed, whole;
    if (!take(kGroup * width / 8, packed)) return false;
    const unsigned ones = (1u << width) - 1;
    for (std::size_t i = 0; i < kGroup; ++i) {
      to[i] = 0;
      if (width == 0) continue;
      const unsigned per_byte = 8 / width, rank = static_cast<unsigned>(i) % per_byte;
      const unsigned place = width == 1 ? rank : per_byte - 1 - rank;  // single bits run upwards
      const unsigned byte = std::to_integer<unsigned>(packed[i / per_byte]);
      to[i] = static_cast<std::uint8_t>(byte >> (place * width) & ones);
      if (width == 8 || to[i] != ones) continue;
      if (!take(1, whole)) return false;
      to[i] = std::uint8_t(whole[0]);
    }
    return true;
  }

  static void add(unsigned mode, const std::array<std::uint8_t, 4>& difference, std::byte* value) {
    if ((mode & 15) == 0) {
      for (std::size_t k = 0; k < 4; ++k) {
        value[k] = std::byte(std::uint8_t(std::uint8_t(value[k]) + from_zigzag(difference[k])));
      }
    } else if ((mode & 15) == 1) {
      const auto halves = std::bit_cast<std::array<std::uint16_t, 2>>(difference);
      for (std::size_t k = 0; k < 2; ++k) {
        std::uint16_t half;
        std::memcpy(&half, value + 2 * k, 2);
        half = static_cast<std::uint16_t>(half + from_zigzag(halves[k]));
        std::memcpy(value + 2 * k, &half, 2);
      }
    } else {
      std::uint32_t whole;
      std::memcpy(&whole, value, 4);
      whole ^= std::rotr(std::bit_cast<std::uint32_t>(difference), static_cast<int>(mode >> 4));
      std::memcpy(value, &whole, 4);
    }
  }

  bool take(std::size_t size, std::span<const std::byte>& bytes) {
    if (size > end_ - at_) return false;
    bytes = stream_.subspan(at_, size);
    at_ += size;
    return true;
  }

  std::span<const std::byte> stream_, modes_;
  std::size_t stride_;
  bool has_modes_ = false;  // version 1
  std::size_t at_ = 0, end_ = 0;
  std::vector<std::byte> previous_;  // element
};

static_assert(std::endian::native == std::endian::little, "so are the streams");

// The highest bit of alpha tells how many bits the components have.
template <typename Signed, typename Unsigned>
void decode_colors(std::span<std::byte> bytes) {
  constexpr float kMost = static_cast<float>(static_cast<Unsigned>(-1));
  for (std::size_t i = 0; i + 4 * sizeof(Signed) <= bytes.size(); i += 4 * sizeof(Signed)) {
    std::array<Signed, 4> in;
    std::memcpy(in.data(), &bytes[i], sizeof in);
    const int luma = static_cast<Unsigned>(in[0]), orange = in[1], green = in[2];
    const unsigned alpha = static_cast<Unsigned>(in[3]);
    const unsigned scale = (1u << std::bit_width(alpha)) - 1;
    const unsigned less = alpha & scale >> 1;
    const std::array<int, 4> colors = {luma + orange - green, luma + green, luma - orange - green,
                                       static_cast<int>(less << 1 | (less & 1))};
    std::array<Unsigned, 4> out{};
    for (std::size_t k = 0; k < 4 && scale > 0; ++k) {
      const float x = static_cast<float>(colors[k]) * (kMost / static_cast<float>(scale));
      out[k] = static_cast<Unsigned>(std::lround(std::clamp(x, 0.0f, kMost)));
    }
    std::memcpy(&bytes[i], out.data(), sizeof out);
  }
}

}  // namespace

std::optional<std::vector<std::byte>> decode_meshopt_attributes(std::span<const std::byte> stream,
                                                                std::size_t count,
                                                                std::size_t stride) {
  return AttributeDecoder(stream, stride).decode(count);
}

void decode_meshopt_colors(std::span<std::byte> bytes, std::size_t stride) {
  if (stride == 4) decode_colors<std::int8_t, std::uint8_t>(bytes);
  if (stride == 8) decode_colors<std::int16_t, std::uint16_t>(bytes);
}

}  // namespace crease
