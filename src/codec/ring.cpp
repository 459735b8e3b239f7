#include "codec/ring.h"

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
  // The start: the triangle that no other leads to; in a closed ring the first.
  std::size_t start = n, starts = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t first = after(triangles[around[i]], center);
    std::size_t leads_here = 0;
    for (std::size_t k = 0; k < n; ++k) {
      leads_here += before(triangles[around[k]], center) == first;
      if (k != i && after(triangles[around[k]], center) == first) return false;
    }
    if (leads_here > 1) return false;
    if (leads_here == 1) continue;
    start = i;
    if (++starts > 1) return false;
  }
  ring.closed = starts == 0;
  if (ring.closed) start = 0;

  ring.triangles.clear();
  ring.vertices.clear();
  std::size_t at = start;
  for (std::size_t step = 0; step < n; ++step) {
    const Corners& t = triangles[around[at]];
    ring.triangles.push_back(around[at]);
    ring.vertices.push_back(after(t, center));
    const std::uint32_t end = before(t, center);
    std::size_t next = 0;
    while (next < n && after(triangles[around[next]], center) != end) ++next;
    if (step + 1 == n) {
      if (!ring.closed) ring.vertices.push_back(end);
      return ring.closed ? next == start : next == n;
    }
    if (next == n || next == start) return false;
    at = next;
  }
  return false;
}

}  // namespace crease::codec
