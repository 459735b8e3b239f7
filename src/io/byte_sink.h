// Bytes of a file in the making: text, and binary in little-endian order.
#pragma once

#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

class ByteSink {
 public:
  void bytes(std::span<const std::byte> b) { bytes_.insert(bytes_.end(), b.begin(), b.end()); }
  void text(std::string_view s) { bytes(std::as_bytes(std::span(s))); }
  // The shortest text that reads back as the same number.
  template <typename Number>
  void number(Number x) {
    char buffer[32];
    const auto got = std::to_chars(buffer, buffer + sizeof buffer, x);
    text({buffer, static_cast<std::size_t>(got.ptr - buffer)});
  }
  void u8(std::uint8_t x) { bytes_.push_back(std::byte{x}); }
  void u16(std::uint16_t x) { little_endian(x); }
  void u32(std::uint32_t x) { little_endian(x); }
  void f32(float x) { little_endian(std::bit_cast<std::uint32_t>(x)); }
  void f64(double x) { little_endian(std::bit_cast<std::uint64_t>(x)); }

  void reserve(std::size_t size) { bytes_.reserve(size); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  template <typename Bits>
  void little_endian(Bits x) {
    for (std::size_t i = 0; i < sizeof(Bits); ++i) bytes_.push_back(std::byte(x >> (8 * i) & 0xff));
  }
  std::vector<std::byte> bytes_;
};

}  // namespace crease
