// Checks of options whose values are numbers.
//
//   command.add_option("--ratio", ratio)->check(number_above(0, 1));
//   // "--ratio: 'nan' is no number above 0 and up to 1"
#pragma once

#include <CLI/CLI.hpp>

#include <limits>

namespace crease::cli {

inline constexpr double kAnyNumber = std::numeric_limits<double>::infinity();

// Finite in any case, and at most `high`.
CLI::Validator number_from(double low, double high = kAnyNumber);
CLI::Validator number_above(double low, double high = kAnyNumber);

// Points to measure with, which may be none where `low` is 0. What is more is no memory's.
CLI::Validator sample_count(double low);

}  // namespace crease::cli
