// Whether a mesh has the very triangle that another has: the same three positions, bit for bit.
//
//   const SameTriangles same(level);
//   if (same.has(full, t)) ...   triangle t of `full` lies in `level` as it is
#pragma once

#include "crease/mesh.h"

#include <cstdint>
#include <vector>

namespace crease {

class SameTriangles {
 public:
  // Keeps a reference. Time O(triangles log triangles), memory 16 bytes a triangle.
  explicit SameTriangles(const Mesh& mesh);

  bool has(const Mesh& other, std::size_t triangle) const;

 private:
  struct Entry {
    std::uint64_t hash = 0;
    std::uint32_t triangle = 0;
  };
  const Mesh& mesh_;
  std::vector<Entry> by_hash_;
};

}  // namespace crease
