// Where a contraction may put its vertex so that a file need not say where both ends were: on the
// segment between them, at an eighth of it, and from there some steps along one axis.
//
//   p[i] = floor(((8 - eighths) * a[i] + eighths * b[i] + 4) / 8), and + steps * step on `axis`
//
// Given p and one end, the other one follows but for a few bits. The best of these places is about
// as good as the best of all where the surface is smooth: `axis` is then the one nearest to the
// normal. Ends may change places if eighths become 8 - eighths.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <optional>

namespace crease {

struct Between {
  int eighths = 4;  // 1 to 7, from a to b
  int axis = 2;
  std::int32_t steps = 0;  // -kMostSteps to kMostSteps
};
inline constexpr std::int32_t kMostSteps = 64;

inline constexpr int kBetweenBits = 6;  // by which a step is shorter than the longer one

// Of the grid, in units, where the ends are so far apart along the other two axes.
inline std::int64_t between_step(std::int64_t apart_first, std::int64_t apart_second) {
  const std::uint64_t apart =
      static_cast<std::uint64_t>(std::max(std::abs(apart_first), std::abs(apart_second)));
  const int width = static_cast<int>(std::bit_width(apart));
  return width > kBetweenBits ? std::int64_t(1) << (width - kBetweenBits) : 1;
}

// On one axis. |a|, |b| < 2^60.
inline std::int64_t between_ends(std::int64_t a, std::int64_t b, int eighths) {
  return ((8 - eighths) * a + eighths * b + 4) >> 3;
}

// The a for which between_ends(a, b, eighths) == p: `count` of them from `first` on, 1 to 8.
struct EndRange {
  std::int64_t first = 0;
  std::uint32_t count = 0;
};
inline EndRange other_ends(std::int64_t b, std::int64_t p, int eighths) {
  const std::int64_t part = 8 - eighths;
  const auto least = [&](std::int64_t sum) {  // a with part * a >= sum
    return sum / part + (sum % part > 0);
  };
  const std::int64_t rest = 8 * p - 4 - eighths * b;
  const std::int64_t first = least(rest);
  return {first, static_cast<std::uint32_t>(least(rest + 8) - first)};
}

// How 0 lies between a and b, if it does; of several ways the one along the last axis, nearest to
// the middle.
inline std::optional<Between> find_between(const std::array<std::int32_t, 3>& a,
                                           const std::array<std::int32_t, 3>& b) {
  constexpr int kEighths[] = {4, 3, 5, 2, 6, 1, 7};
  constexpr std::int32_t kFarthest = 1 << 29;  // so that what a file restores needs no more bits
  for (std::size_t i = 0; i < 3; ++i) {
    if (a[i] < -kFarthest || a[i] > kFarthest || b[i] < -kFarthest || b[i] > kFarthest) return {};
  }
  for (int axis = 2; axis >= 0; --axis) {
    const auto along = static_cast<std::size_t>(axis), first = (along + 1) % 3;
    const std::size_t second = (along + 2) % 3;
    const std::int64_t step = between_step(a[first] - b[first], a[second] - b[second]);
    for (const int eighths : kEighths) {
      if (between_ends(a[first], b[first], eighths) != 0) continue;
      if (between_ends(a[second], b[second], eighths) != 0) continue;
      const std::int64_t off = -between_ends(a[along], b[along], eighths);
      if (off % step != 0 || std::abs(off / step) > kMostSteps) continue;
      return Between{eighths, axis, static_cast<std::int32_t>(off / step)};
    }
  }
  return std::nullopt;
}

}  // namespace crease
