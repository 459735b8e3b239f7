#include "io/split_vertices.h"

namespace crease {

// Split vertices of one mesh vertex form a list (`next`), searched from its head: few each.
SplitVertices split_vertices(const Mesh& mesh, std::span<const AttributeLayer* const> layers) {
  SplitVertices split;
  split.values.resize(layers.size());
  split.of_corner.reserve(3 * mesh.triangle_count());
  std::vector<std::uint32_t> head(mesh.vertex_count(), kNone);
  std::vector<std::uint32_t> next;
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const std::size_t v = index_of(mesh.triangles[corner / 3][corner % 3]);
    const auto is_equal = [&](std::uint32_t s) {
      for (std::size_t l = 0; l < layers.size(); ++l) {
        if (split.values[l][s] != layers[l]->of_corner[corner]) return false;
      }
      return true;
    };
    std::uint32_t s = head[v];
    while (s != kNone && !is_equal(s)) s = next[s];
    if (s == kNone) {
      s = static_cast<std::uint32_t>(split.position.size());
      split.position.push_back(static_cast<std::uint32_t>(v));
      for (std::size_t l = 0; l < layers.size(); ++l) {
        split.values[l].push_back(layers[l]->of_corner[corner]);
      }
      next.push_back(head[v]);
      head[v] = s;
    }
    split.of_corner.push_back(s);
  }
  return split;
}

bool is_per_triangle(const AttributeLayer& layer) {
  for (std::size_t corner = 0; corner < layer.of_corner.size(); corner += 3) {
    const AttributeId* a = &layer.of_corner[corner];
    if (a[0] != a[1] || a[1] != a[2]) return false;
  }
  return true;
}

}  // namespace crease
