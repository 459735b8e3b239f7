#include "hierarchy/witnesses.h"

namespace crease {

Witnesses witnesses_of(const Mesh& mesh, std::span<const Vec3i> positions) {
  Witnesses all;
  all.places.assign(positions.begin(), positions.end());
  all.next.assign(positions.size(), kNone);
  all.told.assign(positions.size(), 0);
  all.first.assign(mesh.triangle_count(), kNone);
  std::vector<char> is_put(positions.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (const VertexId v : mesh.triangles[t]) {
      char& is = is_put[index_of(v)];
      if (is == 0) all.put(static_cast<std::uint32_t>(index_of(v)), t);
      is = 1;
    }
  }
  return all;
}

}  // namespace crease
