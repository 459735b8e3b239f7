#include "codec/ring.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace crease::codec {

namespace {

// Whether no vertex is there twice.
bool are_distinct(std::span<const std::uint32_t> vertices) {
  std::uint64_t seen = 0;
  bool maybe_twice = false;
  for (const std::uint32_t v : vertices) {
    const std::uint64_t bit = std::uint64_t(1) << (v & 63);
    maybe_twice = maybe_twice || (seen & bit) != 0;
    seen |= bit;
  }
  if (!maybe_twice) return true;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const auto before = vertices.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(vertices.begin(), before, *before) != before) return false;
  }
  return true;
}

}  // namespace

bool find_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, Ring& ring) {
  const std::size_t n = around.size();
  if (n == 0 || n > kLargestRing) return false;
  std::array<std::uint32_t, kLargestRing> from, to;  // of each triangle
  for (std::size_t i = 0; i < n; ++i) {
    const Corners& t = triangles[around[i]];
    const std::size_t c = corner_of(t, center);
    from[i] = t[c == 2 ? 0 : c + 1];
    to[i] = t[c == 0 ? 2 : c - 1];
  }
  // Lists are mostly in order already, so the one that follows is the first to be asked.
  const auto find = [n](const std::array<std::uint32_t, kLargestRing>& in, std::uint32_t vertex,
                        std::size_t likely) {
    if (likely < n && in[likely] == vertex) return likely;
    std::size_t i = 0;
    while (i < n && in[i] != vertex) ++i;
    return i;
  };

  // Onwards from the first triangle, back to it or to where the fan ends.
  ring.triangles.resize(n);
  ring.vertices.resize(n);
  std::size_t at = 0, count = 0;
  do {
    ring.triangles[count] = around[at];
    ring.vertices[count] = from[at];
    at = find(from, to[at], at + 1);
    ++count;
  } while (at != 0 && at < n && count < n);
  ring.closed = at == 0;
  if (ring.closed) return count == n && are_distinct(ring.vertices);
  if (at < n) return false;  // round and round without the first

  // An open fan: back from the first triangle to where it starts, and on from there.
  std::size_t start = 0;
  for (std::size_t i = 0; (at = find(to, from[start], start - 1)) < n; ++i) {
    if (i == n) return false;
    start = at;
  }
  std::uint32_t end = 0;
  at = start;
  for (count = 0; at < n && count < n; ++count) {
    ring.triangles[count] = around[at];
    ring.vertices[count] = from[at];
    end = to[at];
    at = find(from, end, at + 1);
  }
  if (at < n || count < n) return false;
  if (!are_distinct(ring.vertices)) return false;  // two start alike
  ring.vertices.push_back(end);
  return true;
}

}  // namespace crease::codec
