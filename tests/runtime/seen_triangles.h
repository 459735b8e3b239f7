// What a picture of a draw list is made of.
#pragma once

#include "crease/draw_list.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace crease {

struct SeenCorner {
  std::array<float, 3> position, normal;
  auto operator<=>(const SeenCorner&) const = default;
};
using SeenTriangle = std::array<SeenCorner, 3>;

inline std::array<float, 3> as_array(const Vec3f& v) {
  return {v.x + 0.0f, v.y + 0.0f, v.z + 0.0f};
}

// What a picture is made of: triangles whose corners are apart. Without normals where those of a
// triangle may change by themselves.
inline std::vector<SeenTriangle> seen(const DrawList& list, bool with_normals) {
  std::vector<SeenTriangle> all;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (std::size_t t = 0; t < part->triangle_count(); ++t) {
      SeenTriangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t slot = part->indices[3 * t + k];
        const Vec3f& n = part == &list.sn   ? list.vertex_normals[slot]
                         : part == &list.fn ? part->normals[t]
                                            : part->normals[3 * t + k];
        triangle[k] = {as_array(list.positions[slot]), with_normals ? as_array(n) : as_array({})};
      }
      const auto& [a, b, c] = triangle;
      if (a.position == b.position || b.position == c.position || c.position == a.position)
        continue;
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                  triangle.end());
      all.push_back(triangle);
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace crease
