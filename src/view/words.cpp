#include "view/words.h"

#include <cstdio>

namespace crease {

namespace {

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

std::string grouped(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, 1, ' ');
  }
  return text;
}

std::string in_bytes(std::uint64_t bytes) {
  const double b = double(bytes);
  if (b < 1e3) return std::to_string(bytes) + " B";
  if (b < 1e6) return formatted("%.3g kB", b / 1e3);
  if (b < 1e9) return formatted("%.3g MB", b / 1e6);
  return formatted("%.3g GB", b / 1e9);
}

std::string in_digits(double value) {
  return formatted("%.4g", value);
}

std::string in_digits(const Vec3d& v) {
  char text[96];
  std::snprintf(text, sizeof text, "%.6g  %.6g  %.6g", v.x, v.y, v.z);
  return text;
}

}  // namespace crease
