#include "crease/draw_list.h"
#include "crease/shading.h"
#include "support/drawn_triangles.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {
namespace {

TEST_CASE("the three parts draw the mesh, each triangle once, by its kind") {
  std::vector<ZooMesh> meshes = mesh_zoo();
  meshes.push_back({"random complex", random_complex(3, 20, 60)});
  for (const ZooMesh& z : meshes) {
    CAPTURE(z.name);
    const MeshDrawArrays arrays(z.mesh);
    const DrawList list = arrays.draw_list();
    const auto place = [&list](const Vec3d& p) {
      const Vec3d from_origin = p - list.origin;
      return Vec3f{float(from_origin.x), float(from_origin.y), float(from_origin.z)};
    };
    CHECK(drawn(list) == drawn_of_mesh(z.mesh, place));
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
