#include "codec/ring.h"

#include <algorithm>

namespace crease::codec {

namespace {

using Ends = std::array<std::uint32_t, kLargestRing + 1>;

// Whether no vertex is there twice.
bool are_distinct(std::span<const std::uint32_t> vertices) {
  std::array<std::uint64_t, 4> seen{};
  std::uint64_t again = 0;
  for (const std::uint32_t v : vertices) {
    const std::uint64_t bit = std::uint64_t(1) << (v & 63);
    std::uint64_t& word = seen[v >> 6 & 3];
    again |= word & bit;
    word |= bit;
  }
  if (again == 0) return true;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const auto before = vertices.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(vertices.begin(), before, *before) != before) return false;
  }
  return true;
}

// Puts triangles and their ends in order, from the first one on or, in an open fan, from that where
// it starts; false if there is none. Time O(n^2), without a branch that depends on who is where.
bool sort_ring(std::span<const std::uint32_t> around, Ring& ring) {
  const std::size_t n = around.size();
  Ends from, to, after, follows;
  std::copy_n(ring.from.begin(), n, from.begin());
  std::copy_n(ring.next.begin(), n, to.begin());
  std::fill_n(follows.begin(), n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t next = n;
    for (std::size_t j = 0; j < n; ++j) next = from[j] == to[i] ? j : next;
    after[i] = static_cast<std::uint32_t>(next);
    follows[next] = 1;
  }
  std::size_t at = 0;
  for (std::size_t i = n; i-- > 0;) at = follows[i] ? at : i;
  for (std::size_t i = 0; i < n; ++i) {
    if (at == n) return false;
    ring.sorted[i] = around[at];
    ring.from[i] = from[at];
    ring.next[i] = to[at];
    at = after[at];
  }
  return true;
}

}  // namespace

bool find_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, Ring& ring) {
  const std::size_t n = around.size();
  if (n == 0 || n > kLargestRing) return false;
  std::uint32_t apart = 0, last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Corners& t = triangles[around[i]];
    const std::size_t c = corner_of(t, center);
    ring.from[i] = t[kCornerAfter[c]];
    ring.next[i] = t[kCornerBefore[c]];
    apart |= i > 0 ? last ^ ring.from[i] : 0;
    last = ring.next[i];
  }
  ring.triangles = around;
  if (apart != 0) {
    if (!sort_ring(around, ring)) return false;
    ring.triangles = {ring.sorted.data(), n};
  }
  ring.closed = ring.next[n - 1] == ring.from[0];
  ring.from[n] = ring.next[n - 1];
  ring.vertices = {ring.from.data(), ring.closed ? n : n + 1};
  return are_distinct(ring.vertices);
}

}  // namespace crease::codec
