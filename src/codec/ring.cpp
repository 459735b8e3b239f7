#include "codec/ring.h"

#include <array>

namespace crease::codec {

namespace {

// Of a triangle's other two vertices the one that follows `center`, or the one before it.
std::uint32_t after(const Corners& t, std::uint32_t center) {
  return t[0] == center ? t[1] : t[1] == center ? t[2] : t[0];
}
std::uint32_t before(const Corners& t, std::uint32_t center) {
  return t[0] == center ? t[2] : t[1] == center ? t[0] : t[1];
}

}  // namespace

bool find_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, Ring& ring) {
  const std::size_t n = around.size();
  if (n == 0 || n > kLargestRing) return false;
  std::array<std::uint32_t, kLargestRing> from, to;  // of each triangle
  for (std::size_t i = 0; i < n; ++i) {
    const Corners& t = triangles[around[i]];
    from[i] = after(t, center);
    to[i] = before(t, center);
  }
  const auto find = [n](const std::array<std::uint32_t, kLargestRing>& in, std::uint32_t vertex) {
    std::size_t i = 0;
    while (i < n && in[i] != vertex) ++i;
    return i;
  };

  // Onwards from the first triangle. Who comes back to it after all n has met each once, so that no
  // two start or end alike.
  ring.triangles.resize(n);
  ring.vertices.resize(n);
  std::size_t at = 0, count = 0;
  do {
    ring.triangles[count] = around[at];
    ring.vertices[count] = from[at];
    at = find(from, to[at]);
    ++count;
  } while (at != 0 && at < n && count < n);
  ring.closed = at == 0;
  if (ring.closed) return count == n;
  if (at < n) return false;  // round and round without the first

  // An open fan: back from the first triangle to where it starts, and on from there.
  std::size_t start = 0;
  for (std::size_t i = 0; (at = find(to, from[start])) < n; ++i) {
    if (i == n) return false;
    start = at;
  }
  std::uint32_t end = 0;
  at = start;
  for (count = 0; at < n && count < n; ++count) {
    ring.triangles[count] = around[at];
    ring.vertices[count] = from[at];
    end = to[at];
    at = find(from, end);
  }
  if (at < n || count < n) return false;
  ring.vertices.push_back(end);
  for (std::size_t i = 0; i < n; ++i) {
    if (find(from, from[i]) != i) return false;  // two start alike
  }
  return true;
}

}  // namespace crease::codec
