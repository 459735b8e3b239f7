#include "mesh/smooth_regions.h"

#include "mesh/disjoint_sets.h"

#include <algorithm>
#include <tuple>

namespace crease {

namespace {

// A side of a triangle, as seen from its smaller vertex. Sides that are equal in all but the
// triangle make a smooth edge.
struct Side {
  VertexId other;
  AttributeId here, there;
  std::uint32_t triangle;

  auto edge() const { return std::tuple(other, here, there); }
  bool operator<(const Side& o) const {
    return std::tuple(other, here, there, triangle) <
           std::tuple(o.other, o.here, o.there, o.triangle);
  }
};

}  // namespace

std::vector<std::uint32_t> smooth_regions(const Mesh& mesh, const CornersAround& around,
                                          const AttributeLayer& layer) {
  DisjointSets regions(mesh.triangle_count());
  std::vector<Side> sides;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    sides.clear();
    for (std::uint32_t corner : around.of(v)) {
      const std::uint32_t t = corner / 3;
      for (std::uint32_t step : {1u, 2u}) {
        const std::uint32_t other = 3 * t + (corner % 3 + step) % 3;
        const VertexId w = mesh.triangles[t][other % 3];
        if (w > VertexId{v})
          sides.push_back({w, layer.of_corner[corner], layer.of_corner[other], t});
      }
    }
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 1; i < sides.size(); ++i) {
      if (sides[i].edge() == sides[i - 1].edge()) {
        regions.unite(sides[i].triangle, sides[i - 1].triangle);
      }
    }
  }
  std::vector<std::uint32_t> region_of_triangle(mesh.triangle_count());
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) region_of_triangle[t] = regions.find(t);
  return region_of_triangle;
}

}  // namespace crease
