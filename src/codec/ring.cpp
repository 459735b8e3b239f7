#include "codec/ring.h"

#include "base/four_floats.h"
#include "crease/ids.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace crease::codec {

namespace {

// Where triangles begin, or end; kNone behind the last one.
using Ends = std::array<std::uint32_t, kLargestRing + 4>;

// Which one has this vertex, of n; n: none.
std::size_t find_end(const Ends& ends, std::size_t n, std::uint32_t vertex) {
  for (std::size_t i = 0; i < n; i += 4) {
    FourInts four;
    std::memcpy(&four, &ends[i], sizeof four);
    const std::uint32_t is = negative_lanes(four == static_cast<std::int32_t>(vertex));
    if (is != 0) return i + static_cast<std::size_t>(std::countr_zero(is));
  }
  return n;
}

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
// it starts; false if there is none. Time O(n^2).
bool sort_ring(std::span<const std::uint32_t> around, Ring& ring) {
  const std::size_t n = around.size();
  Ends from, to;
  std::copy_n(ring.from.begin(), n, from.begin());
  std::copy_n(ring.next.begin(), n, to.begin());
  std::fill_n(from.begin() + static_cast<std::ptrdiff_t>(n), 4, kNone);
  std::fill_n(to.begin() + static_cast<std::ptrdiff_t>(n), 4, kNone);
  const auto put_from = [&](std::size_t at) {
    for (std::size_t i = 0; i < n; ++i) {
      if (at == n) return false;
      ring.sorted[i] = around[at];
      ring.from[i] = from[at];
      ring.next[i] = to[at];
      at = find_end(from, n, to[at]);
    }
    return true;
  };
  if (put_from(0)) return true;
  std::size_t start = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = find_end(to, n, from[start]);
    if (before == n) return put_from(start);
    start = before;
  }
  return false;
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

void fill_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, RingKind kind, Ring& ring) {
  const std::size_t n = around.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Corners& t = triangles[around[i]];
    ring.from[i] = t[kCornerAfter[corner_of(t, center)]];
  }
  ring.triangles = around;
  ring.closed = kind == RingKind::Closed;
  ring.vertices = {ring.from.data(), n};
  if (ring.closed) return;
  const Corners& last = triangles[around[n - 1]];
  ring.from[n] = last[kCornerBefore[corner_of(last, center)]];
  ring.vertices = {ring.from.data(), n + 1};
}

}  // namespace crease::codec
