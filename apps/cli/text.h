// Numbers and option values in words, both ways.
#pragma once

#include "crease/mesh.h"
#include "crease/result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace crease::cli {

std::string grouped(std::uint64_t count);   // 1 234 567
std::string in_bytes(std::uint64_t bytes);  // 12.3 MB
std::string in_length(double length);       // four significant digits
std::string in_all_digits(double number);   // as many as it has
std::string in_percent(double share);       // 0.2 -> "20 %"
std::string in_seconds(double seconds);     // 1.23 s
std::string in_degrees(double degrees);

// What a terminal would obey, in text from elsewhere, as \x1b and the like.
std::string without_controls(std::string_view text);

// The whole text as a finite number, or nothing.
std::optional<double> parse_number(std::string_view text);

// "0.001": a length in model units. "14bits": bits over the longest side.
Result<Precision> parse_precision(std::string_view text);
// "12": from `low` to `high`. "0" and "exact": kExactBits. `option` appears in the message.
Result<int> parse_bits(std::string_view option, std::string_view text, int low, int high);
// "1,0.2,0.02": shares of the triangles, each in (0, 1].
Result<std::vector<double>> parse_ratios(std::string_view text);
// "20Mbit", "500kbit", "2.5MB", "64kB", "1000": bytes a second; letters in any case.
Result<double> parse_rate(std::string_view text);
// "4GB", "512 MiB", "1000000": bytes, above 0 or 0; letters in any case.
Result<std::uint64_t> parse_memory(std::string_view text);
// "1920x1080".
Result<std::pair<int, int>> parse_size(std::string_view text);

}  // namespace crease::cli
