// What a hierarchy promises beside cuts: shading, bounds, bytes, one root; and real models.
#include "pipeline/hierarchy_case.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <set>

namespace crease {
namespace {

void require_valid(const MeshHierarchy& hierarchy) {
  const Status status = check_hierarchy(hierarchy);
  REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : status.failure().message));
}

// The normal of a corner at full resolution and at a cut, for every active triangle.
using SeenNormal = std::function<void(const Vec3f& full, const Vec3f& now)>;
void for_normals(const HierarchyCase& c, const Cut& cut, const SeenNormal& see) {
  for (std::uint32_t t = 0; t < c.mesh.triangle_count(); ++t) {
    const CutTriangle triangle = triangle_at_cut(c, cut, TriangleId{t});
    for (std::size_t k = 0; triangle.is_active && k < 3; ++k) {
      const auto full = c.mesh.layers[0].value(c.mesh.layers[0].of_corner[3 * t + k]);
      const auto now = value_at_cut(c, triangle, 0, TriangleId{t}, k);
      see({full[0], full[1], full[2]}, {now[0], now[1], now[2]});
    }
  }
}

//    +------+
//   /  up  /|     whatever is merged, no side of a box takes the normal of another
//  +------+ |
//  | front| +
//  +------+'
TEST_CASE("no cut shades a box or crossing walls across a hard edge") {
  std::mt19937_64 random(2);
  for (const Mesh& mesh : {hard_box(3), crossing_walls(2, 2)}) {
    const HierarchyCase c = simplified_case(mesh);
    require_valid(c.hierarchy);
    for (int i = 0; i < 40; ++i) {
      for_normals(c, random_cut(c, random),
                  [](const Vec3f& full, const Vec3f& now) { REQUIRE(now == full); });
    }
  }
}

TEST_CASE("no cut shades a cylinder across its rims") {
  std::mt19937_64 random(3);
  const HierarchyCase c = simplified_case(hard_cylinder(12, 3));
  require_valid(c.hierarchy);
  for (int i = 0; i < 60; ++i) {
    for_normals(c, random_cut(c, random), [&](const Vec3f& full, const Vec3f& now) {
      if (std::fabs(full.z) > 0.5f) {
        REQUIRE(now == full);  // a cap
      } else {
        REQUIRE(std::fabs(now.z) < 0.2f);
      }
    });
  }
}

TEST_CASE("categorical values are never made up") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const HierarchyCase c = simplified_case(random_complex(seed, 25, 60));
    require_valid(c.hierarchy);
    const AttributeHierarchy& layer = c.hierarchy.layers[3];
    REQUIRE(layer.interpolation == Interpolation::Categorical);
    const std::set<float> known(c.mesh.layers[3].values.begin(), c.mesh.layers[3].values.end());
    for (std::size_t i = 0; i < layer.values.size(); ++i) {
      REQUIRE(known.contains(layer.values[i][0]));
    }
  }
}

TEST_CASE("full refinement is the snapped mesh, with materials and parts") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const HierarchyCase c = random_case(random_complex(seed, 20, 50), {.seed = seed});
    CHECK(difference_at_level(c, 0) == "");
    const VertexHierarchy& h = c.hierarchy.vertices;
    CHECK(c.hierarchy.materials == c.mesh.materials);
    for (std::size_t t = 0; t < c.mesh.triangle_count(); ++t) {
      const std::size_t n = index_of(c.maps.new_of_triangle[t]);
      REQUIRE(h.material_of_triangle[n] == c.mesh.material_of_triangle[t]);
      REQUIRE(h.part_of_triangle[n] == c.mesh.part_of_triangle[t]);
    }
  }
}

TEST_CASE("down to one root if asked") {
  Mesh mesh = city_blocks(3, 1);
  const Grid grid = make_grid(mesh, {.bits = 16});
  snap(mesh, grid);
  ContractionSequence nothing;
  nothing.grid = grid;
  const MeshHierarchy leaves = *build_hierarchy(mesh, nothing, {});
  require_valid(leaves);
  CHECK(leaves.vertices.root_count == mesh.vertex_count());
  CHECK(leaves.vertices.coarse_triangles().size() == mesh.triangle_count());
  const MeshHierarchy one = *build_hierarchy(mesh, nothing, {.one_root = true});
  require_valid(one);
  CHECK(one.vertices.root_count == 1);
  CHECK(one.vertices.coarse_triangles().size() == 0);
}

TEST_CASE("a mesh without triangles, layers or vertices has a hierarchy") {
  Mesh mesh;
  require_valid(*build_hierarchy(mesh, {}, {}));
  mesh.positions.resize(3);
  const MeshHierarchy points = *build_hierarchy(mesh, {}, {});
  require_valid(points);
  CHECK(points.vertices.root_count == 3);
}

TEST_CASE("errors round up, by less than 0.4 percent") {
  for (float f : {0.0f, 1e-30f, 0.1f, 1.0f, 1.00001f, 3.14159f, 65504.0f, 1e20f}) {
    const float up = RoundedUp::from(f).value();
    CHECK(up >= f);
    CHECK(up <= f * 1.004f);
    CHECK(RoundedUp::from(up) == RoundedUp::from(f));
  }
}

TEST_CASE("deltas of any size come back, up to the ends of the grid") {
  constexpr std::int32_t kEnd = INT32_MAX;
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {kEnd, -kEnd, 5}, {-1, 0, 1}, {-kEnd, kEnd, -kEnd}};
  ContractionSequence sequence;
  for (std::uint32_t i = 1; i < 4; ++i) {
    Contraction c;
    c.removed = VertexId{i};
    c.kept = VertexId{0};
    c.position = {static_cast<std::int32_t>(i), i == 2 ? -kEnd : 0, 0};
    sequence.contractions.push_back(c);
  }
  const HierarchyCase c = case_of(mesh, sequence);
  require_valid(c.hierarchy);
  for (std::uint32_t v = 0; v < 4; ++v) {
    CHECK(c.hierarchy.vertices.position_of(c.maps.leaf_of_vertex[v]) ==
          sequence.grid.nearest(mesh.positions[v]));
  }
}

TEST_CASE("a smooth mesh takes at most 80 bytes a vertex") {
  const HierarchyCase c = simplified_case(torus(60, 60));
  require_valid(c.hierarchy);
  CHECK(hierarchy_bytes(c.hierarchy).total() <= 80 * c.mesh.vertex_count());
}

TEST_CASE("any cut of real models is that of the plain definition") {
  std::mt19937_64 random(8);
  for (const ZooMesh& z : real_meshes(kSanitized ? 2000 : 20'000)) {
    CAPTURE(z.name);
    const HierarchyCase c = simplified_case(z.mesh);
    require_valid(c.hierarchy);
    REQUIRE(check_hard_edges(c.hierarchy).ok());
    REQUIRE(check_leaves(c.hierarchy, c.maps, c.mesh).ok());
    const std::size_t count = c.sequence.contractions.size();
    for (std::size_t level = 0; level <= 8; ++level) {
      REQUIRE(difference_at_level(c, count * level / 8) == "");
    }
    for (int i = 0; i < 20; ++i) REQUIRE(difference_at_cut(c, random_cut(c, random)) == "");
  }
}

}  // namespace
}  // namespace crease
