// The corners of every vertex, by counting: 3 * triangle + corner, ascending.
#pragma once

#include "crease/mesh.h"

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace crease {

class CornersAround {
 public:
  explicit CornersAround(const Mesh& mesh) : first_(mesh.vertex_count() + 1, 0) {
    for (const Triangle& t : mesh.triangles) {
      for (VertexId v : t) ++first_[index_of(v) + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    corners_.resize(3 * mesh.triangle_count());
    std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
    for (std::uint32_t corner = 0; corner < corners_.size(); ++corner) {
      corners_[fill[index_of(mesh.triangles[corner / 3][corner % 3])]++] = corner;
    }
  }
  std::span<const std::uint32_t> of(std::size_t vertex) const {
    return std::span<const std::uint32_t>(corners_).subspan(first_[vertex],
                                                            first_[vertex + 1] - first_[vertex]);
  }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace crease
