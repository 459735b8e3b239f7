// Triangles into groups that are small in space and number, so that a view can leave out most of
// what is beside it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace crease {

// Of a group at most; it has at least half as many where there were more.
inline constexpr std::size_t kGroupTriangles = 32;

// The middle of order[begin, end), on whose left side are those whose places are lowest along the
// longest side of their box. `place_of(t)`: three numbers, sums of the corners for instance.
template <typename PlaceOf>
std::size_t halve_by_place(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end,
                           const PlaceOf& place_of) {
  auto low = place_of(order[begin]), high = low;
  for (std::size_t i = begin; i < end; ++i) {
    const auto at = place_of(order[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], at[k]);
      high[k] = std::max(high[k], at[k]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  const auto at = [&order](std::size_t i) { return order.begin() + std::ptrdiff_t(i); };
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    const auto x = place_of(a)[axis], y = place_of(b)[axis];
    return x != y ? x < y : a < b;
  });
  return middle;
}

// Halves order[begin, end) until the groups are small; the order within stays. Adds the groups'
// ends.
template <typename PlaceOf>
void group_by_place(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end,
                    const PlaceOf& place_of, std::vector<std::size_t>& ends) {
  if (end - begin <= kGroupTriangles) return ends.push_back(end);
  const std::size_t middle = halve_by_place(order, begin, end, place_of);
  const auto at = [&order](std::size_t i) { return order.begin() + std::ptrdiff_t(i); };
  std::sort(at(begin), at(middle));
  std::sort(at(middle), at(end));
  group_by_place(order, begin, middle, place_of, ends);
  group_by_place(order, middle, end, place_of, ends);
}

}  // namespace crease
