// The triangles around a vertex in the order in which they follow each other, where there is one.
#pragma once

#include "codec/patch_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace crease::codec {

inline constexpr std::size_t kLargestRing = 256;

// Triangle i lies between the vertices i and i + 1, counter-clockwise. Closed: as many vertices as
// triangles, the last triangle ends at vertex 0. Open: one vertex more. Good until the list that it
// was found in changes.
struct Ring {
  std::span<const std::uint32_t> triangles, vertices;
  bool closed = false;
  std::array<std::uint32_t, kLargestRing> sorted;          // triangles, unless they were in order
  std::array<std::uint32_t, kLargestRing + 1> from, next;  // where triangles begin and end
};

// Whether the triangles around `center` are one fan, and which. One that has more than kLargestRing
// triangles is none: looking for neighbours takes square time, unless they are in order already.
bool find_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, Ring& ring);

// What is known of the triangles around a vertex: nothing, or that they are such a fan in order.
enum class RingKind : std::uint8_t { Unknown, Closed, Open };

// The same of a fan whose triangles are in order already; `kind` says which.
void fill_ring(std::span<const Corners> triangles, std::span<const std::uint32_t> around,
               std::uint32_t center, RingKind kind, Ring& ring);

}  // namespace crease::codec
