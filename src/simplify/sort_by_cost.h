// The pairs of a band's start in the order of their costs.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease::simplification {

// By cost, then in the order of the pairs, in which they come. Costs are not negative, so their
// bits are in their order; eleven bits at a time.
template <class Ordered>
void sort_by_cost(std::vector<Ordered>& entries, std::vector<Ordered>& scratch) {
  constexpr std::size_t kFew = 1000;  // the tables below would cost more than they save
  if (entries.size() < kFew) {
    std::sort(entries.begin(), entries.end(), [](const Ordered& x, const Ordered& y) {
      return x.cost != y.cost ? x.cost < y.cost : x.pair < y.pair;
    });
    return;
  }
  constexpr std::uint32_t kBits = 11, kDigits = 1u << kBits;
  std::array<std::array<std::uint32_t, kDigits>, 3> first{};
  const auto digit_of = [](const Ordered& e, std::uint32_t i) {
    return (std::bit_cast<std::uint32_t>(e.cost) >> (i * kBits)) % kDigits;
  };
  for (const Ordered& e : entries) {
    for (std::uint32_t i = 0; i < 3; ++i) ++first[i][digit_of(e, i)];
  }
  scratch.resize(entries.size());
  for (std::uint32_t i = 0; i < 3; ++i) {
    std::uint32_t next = 0;
    for (std::uint32_t& f : first[i]) next += std::exchange(f, next);
    for (const Ordered& e : entries) scratch[first[i][digit_of(e, i)]++] = e;
    entries.swap(scratch);
  }
}

}  // namespace crease::simplification
