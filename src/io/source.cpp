#include "crease/vec.h"
#include "io/formats.h"
#include "io/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace crease {

namespace {

// Bytes of the UTF-8 character that `text` begins with; 0 if it is a control character or none
// (RFC 3629: the shortest form, no surrogate, at most U+10FFFF).
std::size_t printable_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= ' ' && first != 0x7f ? 1 : 0;
  const std::size_t length = first < 0xc0 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (length == 0 || first >= 0xf8 || text.size() < length) return 0;
  std::uint32_t code = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0u) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t kFirst[] = {0xa0, 0x800, 0x10000};  // of 2, 3, 4; below 0xa0 is control
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return code >= kFirst[length - 2] && code <= 0x10ffff && !is_surrogate ? length : 0;
}

}  // namespace

Failure fail_at_line(Error error, const Source& source, std::size_t line,
                     const std::string& reason) {
  return fail(error, source.name + ":" + std::to_string(line) + ": " + reason);
}

Failure fail_at_byte(Error error, const Source& source, std::size_t offset,
                     const std::string& reason) {
  return fail(error, source.name + ": byte " + std::to_string(offset) + ": " + reason);
}

bool is_position(const Vec3d& p) {
  // NaN compares false.
  return std::abs(p.x) <= kMaxCoordinate && std::abs(p.y) <= kMaxCoordinate &&
         std::abs(p.z) <= kMaxCoordinate;
}

const char* fault_of(const Vec3d& p) {
  const bool is_finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  return is_finite ? "beyond 1e30" : "not finite";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string out = "'";
  for (std::size_t i = 0; i < kLongest && !text.empty(); ++i) {
    const std::size_t length = printable_length(text);
    out += length > 0 ? text.substr(0, length) : "?";
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out + (text.empty() ? "'" : "...'");
}

}  // namespace crease
