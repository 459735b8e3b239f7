#include "cli/text.h"

#include "crease/attribute_precision.h"

#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <span>

namespace crease::cli {

namespace {

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  char buffer[64];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(buffer, sizeof buffer, pattern, arguments);
  va_end(arguments);
  return buffer;
}

// The whole text as an integer in [low, high], or nothing.
std::optional<int> parse_int(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (value < low || value > high) return std::nullopt;
  return value;
}

struct Unit {
  std::string_view name;  // in small letters
  double size;
};

// A number and a unit, the first of `units` that the text ends with; blanks between them are fine.
std::optional<double> parse_in_units(std::string_view text, std::span<const Unit> units) {
  std::string lowered(text);
  for (char& c : lowered) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const Unit& unit : units) {
    if (!lowered.ends_with(unit.name)) continue;
    std::string_view number = lowered;
    number.remove_suffix(unit.name.size());
    while (number.ends_with(' ')) number.remove_suffix(1);
    const auto count = parse_number(number);
    if (!count) return std::nullopt;
    return *count * unit.size;
  }
  return std::nullopt;
}

}  // namespace

std::string grouped(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string spaced;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) spaced += ' ';
    spaced += digits[i];
  }
  return spaced;
}

std::string in_bytes(std::uint64_t bytes) {
  const double b = static_cast<double>(bytes);
  if (bytes < 1000) return format("%.0f B", b);
  if (bytes < 1000'000) return format("%.1f kB", b / 1e3);
  if (bytes < 1000'000'000) return format("%.1f MB", b / 1e6);
  return format("%.2f GB", b / 1e9);
}

std::string in_length(double length) {
  return format("%.4g", length);
}
std::string in_all_digits(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string in_percent(double share) {
  return format("%.4g %%", 100 * share);
}
std::string in_seconds(double seconds) {
  return format("%.2f s", seconds);
}
std::string in_degrees(double degrees) {
  return format("%.3g deg", degrees);
}

std::string without_controls(std::string_view text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    // U+0080 to U+009F are controls as well; in UTF-8 their second byte is their number.
    const bool is_second = i > 0 && text[i - 1] == '\xc2' && byte >= 0x80 && byte < 0xa0;
    shown += byte < 0x20 || byte == 0x7f || is_second ? format("\\x%02x", byte)
                                                      : std::string(1, text[i]);
  }
  return shown;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

Result<Precision> parse_precision(std::string_view text) {
  constexpr std::string_view kBits = "bits";
  if (text.ends_with(kBits)) {
    const auto bits = parse_int(text.substr(0, text.size() - kBits.size()), 1, 30);
    if (!bits) return fail(Error::CommandLine, "--precision: bits go from 1bits to 30bits");
    return Precision{.length = 0, .bits = *bits};
  }
  const auto length = parse_number(text);
  if (!length || *length <= 0) {
    return fail(
        Error::CommandLine,
        "--precision: '" + std::string(text) +
            "' is neither a length above 0 (0.001) nor bits over the longest side (14bits)");
  }
  return Precision{.length = *length};
}

Result<int> parse_bits(std::string_view option, std::string_view text, int low, int high) {
  if (text == "exact" || text == "0") return kExactBits;
  const auto bits = parse_int(text, low, high);
  if (bits) return *bits;
  return fail(Error::CommandLine, std::string(option) + ": '" + std::string(text) +
                                      "' is neither bits from " + std::to_string(low) + " to " +
                                      std::to_string(high) + " nor 'exact'");
}

Result<std::vector<double>> parse_ratios(std::string_view text) {
  std::vector<double> ratios;
  while (true) {
    const std::size_t comma = text.find(',');
    const std::string_view word = text.substr(0, comma);
    const auto ratio = parse_number(word);
    if (!ratio || *ratio <= 0 || *ratio > 1) {
      return fail(Error::CommandLine, "--levels: '" + std::string(word) +
                                          "' is no share of the triangles above 0 and up to 1");
    }
    ratios.push_back(*ratio);
    if (comma == std::string_view::npos) return ratios;
    text.remove_prefix(comma + 1);
  }
}

Result<double> parse_rate(std::string_view text) {
  constexpr Unit kUnits[] = {{"kbit", 1e3 / 8},
                             {"mbit", 1e6 / 8},
                             {"gbit", 1e9 / 8},
                             {"kb", 1e3},
                             {"mb", 1e6},
                             {"gb", 1e9},
                             {"", 1}};
  const auto rate = parse_in_units(text, kUnits);
  if (rate && *rate > 0) return *rate;
  return fail(Error::CommandLine, "--limit: '" + std::string(text) +
                                      "' is no rate like 20Mbit, 2.5MB or 1000 (bytes a second)");
}

Result<std::uint64_t> parse_memory(std::string_view text) {
  constexpr Unit kUnits[] = {
      {"kib", 1 << 10}, {"mib", 1 << 20}, {"gib", 1 << 30}, {"tib", double(std::uint64_t(1) << 40)},
      {"kb", 1e3},      {"mb", 1e6},      {"gb", 1e9},      {"tb", 1e12},
      {"", 1}};
  constexpr double kMost = 1e18;
  const auto bytes = parse_in_units(text, kUnits);
  if (bytes && *bytes >= 0 && *bytes <= kMost) return static_cast<std::uint64_t>(*bytes);
  return fail(Error::CommandLine, "--memory: '" + std::string(text) +
                                      "' is no size like 4GB, 512MiB or 1000000000 (bytes)");
}

Result<std::pair<int, int>> parse_size(std::string_view text) {
  constexpr int kMaxSide = 16384;
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const auto width = parse_int(text.substr(0, cross), 16, kMaxSide);
    const auto height = parse_int(text.substr(cross + 1), 16, kMaxSide);
    if (width && height) return std::pair(*width, *height);
  }
  return fail(Error::CommandLine, "--size: '" + std::string(text) +
                                      "' is not WIDTHxHEIGHT with sides from 16 to 16384");
}

}  // namespace crease::cli
