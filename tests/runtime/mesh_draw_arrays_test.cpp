#include "crease/draw_list.h"
#include "crease/shading.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace crease {
namespace {

using Key = std::tuple<float, float, float>;
Key key(const Vec3f& v) {
  return {v.x, v.y, v.z};
}

// Triangles as a multiset of corner positions and normals.
using Bag = std::map<std::vector<Key>, int>;

Bag drawn(const DrawList& list) {
  Bag bag;
  for (const DrawPart* part : {&list.sn, &list.fn, &list.nsn}) {
    for (std::size_t t = 0; t < part->triangle_count(); ++t) {
      std::vector<Key> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = part->indices[3 * t + k];
        corners.push_back(key(list.positions[v]));
        corners.push_back(key(part == &list.sn   ? list.vertex_normals[v]
                              : part == &list.fn ? part->normals[t]
                                                 : part->normals[3 * t + k]));
      }
      ++bag[corners];
    }
  }
  return bag;
}

Bag expected(const Mesh& mesh, const Vec3d& origin) {
  Bag bag;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::vector<Key> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = mesh.positions[index_of(mesh.triangles[t][k])] - origin;
      corners.push_back({float(p.x), float(p.y), float(p.z)});
      const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + k]);
      corners.push_back({n[0], n[1], n[2]});
    }
    ++bag[corners];
  }
  return bag;
}

TEST_CASE("the three parts draw the mesh, each triangle once, by its kind") {
  std::vector<ZooMesh> meshes = mesh_zoo();
  meshes.push_back({"random complex", random_complex(3, 20, 60)});
  for (const ZooMesh& z : meshes) {
    CAPTURE(z.name);
    const MeshDrawArrays arrays(z.mesh);
    const DrawList list = arrays.draw_list();
    CHECK(drawn(list) == expected(z.mesh, list.origin));
    const ShadingKinds kinds = classify_shading(z.mesh);
    const auto count = [&kinds](TriangleKind kind) {
      return static_cast<std::size_t>(std::ranges::count(kinds.of_triangle, kind));
    };
    CHECK(list.sn.triangle_count() == count(TriangleKind::SN));
    CHECK(list.fn.triangle_count() == count(TriangleKind::FN));
    CHECK(list.nsn.triangle_count() == count(TriangleKind::NSN));
  }
}

}  // namespace
}  // namespace crease
