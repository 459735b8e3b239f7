// Little-endian bytes, field by field.
//
//   ByteWriter out;  out.u32(7);  out.text("brick");
//   ByteReader in(out.bytes());  in.u32();  in.text();  if (in.truncated()) return fail(...);
//
// Reads past the end give zero and set truncated(), so a header is read first and judged once.
// Arrays are compared with what remains before memory is taken.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease {

// One number; the caller has checked that its four bytes are there.
inline std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= std::to_integer<std::uint32_t>(bytes[offset + i]) << (8 * i);
  }
  return value;
}

class ByteWriter {
 public:
  void u8(std::uint8_t v) { bytes_.push_back(std::byte{v}); }
  void u16(std::uint16_t v) { number(v); }
  void u32(std::uint32_t v) { number(v); }
  void u64(std::uint64_t v) { number(v); }
  void f32(float v) { number(std::bit_cast<std::uint32_t>(v)); }
  void f64(double v) { number(std::bit_cast<std::uint64_t>(v)); }
  // u32 length, then the bytes.
  void text(std::string_view s) {
    u32(static_cast<std::uint32_t>(s.size()));
    const auto* begin = reinterpret_cast<const std::byte*>(s.data());
    bytes_.insert(bytes_.end(), begin, begin + s.size());
  }
  void u32s(std::span<const std::uint32_t> values) {
    bytes_.reserve(bytes_.size() + values.size_bytes());
    for (std::uint32_t v : values) u32(v);
  }
  void f32s(std::span<const float> values) {
    bytes_.reserve(bytes_.size() + values.size_bytes());
    for (float v : values) f32(v);
  }
  void append(std::span<const std::byte> more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
  }

  const std::vector<std::byte>& bytes() const { return bytes_; }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  template <typename T>
  void number(T v) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_.push_back(std::byte(static_cast<std::uint8_t>(v >> (8 * i))));
    }
  }

  std::vector<std::byte> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return number<std::uint8_t>(); }
  std::uint16_t u16() { return number<std::uint16_t>(); }
  std::uint32_t u32() { return number<std::uint32_t>(); }
  std::uint64_t u64() { return number<std::uint64_t>(); }
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }
  std::string text() {
    const std::uint32_t length = u32();
    if (length > remaining()) {
      truncated_ = true;
      offset_ = bytes_.size();
      return {};
    }
    std::string s(reinterpret_cast<const char*>(bytes_.data()) + offset_, length);
    offset_ += length;
    return s;
  }
  // The next `count` bytes as they are; none, and truncated(), where there are not as many.
  std::span<const std::byte> take(std::size_t count) {
    if (count > remaining()) {
      truncated_ = true;
      offset_ = bytes_.size();
      return {};
    }
    offset_ += count;
    return bytes_.subspan(offset_ - count, count);
  }
  // Everything that remains. What does not fill a whole value sets truncated().
  std::vector<std::uint32_t> rest_u32s() {
    std::vector<std::uint32_t> values(remaining() / 4);
    for (std::uint32_t& v : values) v = u32();
    if (remaining() > 0) truncated_ = true;
    return values;
  }
  std::vector<float> rest_f32s() {
    std::vector<float> values(remaining() / 4);
    for (float& v : values) v = f32();
    if (remaining() > 0) truncated_ = true;
    return values;
  }

  std::size_t offset() const { return offset_; }
  std::size_t remaining() const { return bytes_.size() - offset_; }
  bool truncated() const { return truncated_; }

 private:
  template <typename T>
  T number() {
    if (sizeof(T) > remaining()) {
      truncated_ = true;
      offset_ = bytes_.size();
      return 0;
    }
    T v = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      v = static_cast<T>(v | static_cast<T>(std::to_integer<std::uint8_t>(bytes_[offset_ + i]))
                                 << (8 * i));
    }
    offset_ += sizeof(T);
    return v;
  }

  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
  bool truncated_ = false;
};

}  // namespace crease
