#include "io/meshopt_attributes.h"

#include <doctest/doctest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace crease {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Elements that wander: each of 16-bit numbers that are near those of the one before, but now and
// then a far one; the last channel is the same in all.
Bytes wandering(std::size_t count, std::size_t stride) {
  std::mt19937 random(7);
  std::vector<std::uint16_t> numbers(stride / 2, 1000);
  Bytes elements;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k + 2 < numbers.size(); ++k) {
      const auto step = static_cast<int>(random() % (random() % 9 == 0 ? 60'000 : 9));
      numbers[k] = static_cast<std::uint16_t>(numbers[k] + step - 4);
    }
    for (std::uint16_t x : numbers) {
      elements.push_back(static_cast<std::uint8_t>(x));
      elements.push_back(static_cast<std::uint8_t>(x >> 8));
    }
  }
  return elements;
}

template <typename T>
T zigzag(T x) {
  return static_cast<T>(x << 1 ^ (x >> (8 * sizeof(T) - 1) != 0 ? T(-1) : T(0)));
}

constexpr int kTurn = 5;
std::uint8_t mode_of_channel(std::size_t channel) {
  return static_cast<std::uint8_t>(channel % 3 == 2 ? 2 | kTurn << 4 : channel % 3);
}

std::array<std::uint8_t, 4> difference(std::uint8_t mode, const std::uint8_t* from,
                                       const std::uint8_t* to) {
  std::array<std::uint8_t, 4> d{};
  if (mode == 0) {
    for (std::size_t k = 0; k < 4; ++k) d[k] = zigzag(static_cast<std::uint8_t>(to[k] - from[k]));
  } else if (mode == 1) {
    for (std::size_t k = 0; k < 4; k += 2) {
      const int x = to[k] + 256 * to[k + 1] - from[k] - 256 * from[k + 1];
      const auto coded = zigzag(static_cast<std::uint16_t>(x));
      d[k] = static_cast<std::uint8_t>(coded);
      d[k + 1] = static_cast<std::uint8_t>(coded >> 8);
    }
  } else {
    std::uint32_t a, b;
    std::memcpy(&a, from, 4);
    std::memcpy(&b, to, 4);
    d = std::bit_cast<std::array<std::uint8_t, 4>>(std::rotl(a ^ b, kTurn));
  }
  return d;
}

void add_group(Bytes& out, const std::uint8_t* d, unsigned width) {
  if (width == 0) return;
  const unsigned ones = (1u << width) - 1, per_byte = 8 / width;
  Bytes behind;
  for (unsigned i = 0; i < 16; ++i) {
    if (i % per_byte == 0) out.push_back(0);
    const bool fits = width == 8 || d[i] < ones;
    const unsigned rank = i % per_byte, place = width == 1 ? rank : per_byte - 1 - rank;
    out.back() = static_cast<std::uint8_t>(out.back() | (fits ? d[i] : ones) << (place * width));
    if (!fits) behind.push_back(d[i]);
  }
  out.insert(out.end(), behind.begin(), behind.end());
}

// Uses every control and width in turn, and no sense.
Bytes version_1(const Bytes& elements, std::size_t stride) {
  const std::size_t count = elements.size() / stride;
  const std::size_t most = std::min<std::size_t>(8192 / stride / 16 * 16, 256);
  Bytes out = {0xa1}, previous(elements.begin(), elements.begin() + std::ptrdiff_t(stride));
  const Bytes first = previous;
  for (std::size_t begin = 0; begin < count; begin += most) {
    const std::size_t n = std::min(most, count - begin);
    std::vector<Bytes> differences(stride, Bytes((n + 15) / 16 * 16));
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint8_t* element = &elements[(begin + i) * stride];
      for (std::size_t k = 0; k < stride; k += 4) {
        const auto d = difference(mode_of_channel(k / 4), &previous[k], element + k);
        for (std::size_t j = 0; j < 4; ++j) differences[k + j][i] = d[j];
      }
      previous.assign(element, element + stride);
    }
    const std::size_t controls = out.size();
    out.resize(controls + stride / 4);
    for (std::size_t k = 0; k < stride; ++k) {
      const Bytes& d = differences[k];
      const bool is_zero = std::ranges::count(d, 0) == std::ptrdiff_t(d.size());
      const unsigned control = is_zero ? 2 : std::array<unsigned, 3>{0, 1, 3}[k % 3];
      out[controls + k / 4] =
          static_cast<std::uint8_t>(out[controls + k / 4] | control << (2 * (k % 4)));
      if (control == 3) out.insert(out.end(), d.begin(), d.begin() + std::ptrdiff_t(n));
      if (control > 1) continue;
      const std::size_t header = out.size(), groups = d.size() / 16;
      out.resize(header + (groups + 3) / 4);
      for (std::size_t g = 0; g < groups; ++g) {
        const unsigned bits = control == 0 ? 1 + unsigned(g) % 3 : unsigned(g) % 4;
        out[header + g / 4] =
            static_cast<std::uint8_t>(out[header + g / 4] | bits << (2 * (g % 4)));
        add_group(out, &d[16 * g], control == 0 ? std::array{0u, 1u, 2u, 4u}[bits] : 1u << bits);
      }
    }
  }
  const std::size_t tail = stride + stride / 4;
  out.resize(out.size() + 24 - std::min<std::size_t>(tail, 24));
  out.insert(out.end(), first.begin(), first.end());
  for (std::size_t c = 0; c < stride / 4; ++c) out.push_back(mode_of_channel(c));
  return out;
}

bool decodes_to(const Bytes& stream, std::size_t stride, const Bytes& expected) {
  const auto got =
      decode_meshopt_attributes(std::as_bytes(std::span(stream)), expected.size() / stride, stride);
  return got && std::ranges::equal(*got, std::as_bytes(std::span(expected)));
}

TEST_CASE("meshopt: attributes of version 1, in every way that they may be packed") {
  for (std::size_t stride : {4, 8, 12, 28, 256}) {
    for (std::size_t count : {1, 16, 40, 256, 700}) {
      CAPTURE(stride);
      CAPTURE(count);
      const Bytes elements = wandering(count, stride);
      CHECK(decodes_to(version_1(elements, stride), stride, elements));
    }
  }
}

TEST_CASE("meshopt: attributes of version 0 are what the library reads") {
  for (std::size_t stride : {4, 12, 256}) {
    const std::size_t count = 300;
    const Bytes elements = wandering(count, stride);
    Bytes stream(meshopt_encodeVertexBufferBound(count, stride));
    stream.resize(
        meshopt_encodeVertexBuffer(stream.data(), stream.size(), elements.data(), count, stride));
    CHECK(decodes_to(stream, stride, elements));
  }
}

// The extension's own example of a group of 4 bits.
TEST_CASE("meshopt: differences that need more bits stand behind their group") {
  Bytes stream = {0xa1, 0xa8, 0x02, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5};
  stream[1] = 0b10'10'10'01;  // one byte of four is packed
  stream.resize(stream.size() + 24);
  Bytes expected;
  std::uint8_t value = 0;
  for (int d : {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0}) {
    value = static_cast<std::uint8_t>(value + d);
    expected.insert(expected.end(), {value, 0, 0, 0});
  }
  CHECK(decodes_to(stream, 4, expected));
}

TEST_CASE("meshopt: a stream that is cut, goes on or was harmed is none, or another") {
  const std::size_t stride = 12, count = 40;
  const Bytes elements = wandering(count, stride), whole = version_1(elements, stride);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes part(whole.begin(), whole.begin() + std::ptrdiff_t(size));  // so that asan sees
    CHECK(!decodes_to(part, stride, elements));
  }
  Bytes longer = whole;
  longer.insert(longer.begin() + 1, 0);
  CHECK(!decodes_to(longer, stride, elements));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    Bytes harmed = whole;
    harmed[i] ^= 0x5a;
    static_cast<void>(decode_meshopt_attributes(std::as_bytes(std::span(harmed)), count, stride));
  }
  for (int mode : {3, 0x10, 0x11, 0x43}) {  // of the first channel
    Bytes unknown = whole;
    unknown[unknown.size() - 3] = static_cast<std::uint8_t>(mode);
    CHECK(!decode_meshopt_attributes(std::as_bytes(std::span(unknown)), count, stride));
  }
}

TEST_CASE("meshopt: colours of as many bits as alpha tells") {
  const auto decoded = []<typename T>(std::vector<T> values, std::size_t stride) {
    decode_meshopt_colors(std::as_writable_bytes(std::span(values)), stride);
    return values;
  };
  CHECK(decoded(Bytes{100, 50, 20, 0xff, 10, std::uint8_t(-2), 1, 0b1101}, 4) ==
        Bytes{130, 120, 30, 255, 119, 187, 187, 187});
  using Shorts = std::vector<std::uint16_t>;
  CHECK(decoded(Shorts{40'000, 100, std::uint16_t(-200), 0xffff}, 8) ==
        Shorts{40'300, 39'800, 40'100, 65'535});
  CHECK(decoded(Bytes{1, 2, 3, 0}, 4) == Bytes{0, 0, 0, 0});
}

}  // namespace
}  // namespace crease
