// The triangles around a vertex in the order in which they follow each other, where there is one.
#pragma once

#include "codec/patch_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace crease::codec {

// Triangle i lies between the vertices i and i + 1, counter-clockwise. Closed: as many vertices as
// triangles, the last triangle ends at vertex 0. Open: one vertex more.
struct Ring {
  std::vector<std::uint32_t> triangles, vertices;
  bool closed = false;
};

// Whether the triangles around `center` are one fan, and which. One that has more than kLargestRing
// triangles is none: looking for neighbours takes square time.
inline constexpr std::size_t kLargestRing = 256;
bool find_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, Ring& ring);

}  // namespace crease::codec
