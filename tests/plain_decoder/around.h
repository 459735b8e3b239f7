// docs/format-block.md, "Around a vertex": what of the mesh so far the models ask for.
#pragma once

#include "plain_decoder/arithmetic.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace plain {

using Triangle = std::array<std::uint32_t, 3>;  // its corners' vertices
using Numbers = std::vector<std::uint32_t>;

inline constexpr std::uint32_t kNone = 0xffffffffu;

// So many of a long list are looked at.
inline constexpr std::size_t kLongest = 256;

// Triangles that are one fan, in its order; w has one vertex more if it is open.
struct Fan {
  Numbers triangles, w;
  bool closed = false;
};

class Surface {
 public:
  std::vector<Point> places;              // per vertex
  std::vector<Triangle> triangles;        //
  std::vector<Numbers> triangles_around;  // per vertex: its list

  std::uint32_t add_vertex(const Point& place);
  std::uint32_t add_triangle(const Triangle& corners);

  // The list, or its first 256.
  const Numbers& list(std::uint32_t v) const { return triangles_around[v]; }
  Numbers first_of_list(std::uint32_t v) const;

  std::uint32_t start_of(std::uint32_t t, std::uint32_t v) const;  // the corner after v
  std::uint32_t end_of(std::uint32_t t, std::uint32_t v) const;    // the corner before v
  bool has_corner(std::uint32_t t, std::uint32_t v) const;
  std::optional<Fan> fan(std::uint32_t v) const;
  FloatVector twice_area(std::uint32_t t) const;
  std::size_t bend(std::uint32_t t, std::uint32_t other) const;
  Numbers neighbours_before(std::uint32_t t) const;  // in the order of the edges
};

}  // namespace plain
