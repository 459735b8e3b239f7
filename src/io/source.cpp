#include "crease/vec.h"
#include "io/formats.h"
#include "io/text.h"

#include <cmath>

namespace crease {

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
  for (char c : text.substr(0, kLongest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > kLongest ? "...'" : "'");
}

}  // namespace crease
