#include "cli/number_check.h"

#include "cli/text.h"

#include <cstdio>
#include <optional>
#include <string>

namespace crease::cli {

namespace {

std::string in_digits(double x) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.15g", x);
  return digits;
}

CLI::Validator number_check(bool is_wanted(double x, double low), double low, double high,
                            const std::string& wanted) {
  return CLI::Validator(
      [=](std::string& text) -> std::string {
        const std::string_view digits = std::string_view(text).substr(text.starts_with('+'));
        const std::optional<double> x = parse_number(digits);
        if (x && is_wanted(*x, low) && *x <= high) return "";
        return "'" + text + "' is no number " + wanted;
      },
      "");
}

}  // namespace

CLI::Validator number_from(double low, double high) {
  const auto is_wanted = [](double x, double lowest) { return x >= lowest; };
  return number_check(is_wanted, low, high,
                      high < kAnyNumber ? "from " + in_digits(low) + " to " + in_digits(high)
                                        : "of " + in_digits(low) + " or more");
}

CLI::Validator number_above(double low, double high) {
  const auto is_wanted = [](double x, double lowest) { return x > lowest; };
  return number_check(
      is_wanted, low, high,
      "above " + in_digits(low) + (high < kAnyNumber ? " and up to " + in_digits(high) : ""));
}

CLI::Validator sample_count(double low) {
  constexpr double kMostSamples = 1e9;
  return number_from(low, kMostSamples);
}

}  // namespace crease::cli
