// What AdaptiveMesh shows, and what a renderer has to fetch of it.
#include "crease/adaptive_mesh.h"
#include "hierarchy/geometric_normal.h"
#include "pipeline/hierarchy_case.h"
#include "runtime/draw_values.h"
#include "runtime/random_camera.h"
#include "runtime/renderer_copy.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>

namespace crease {
namespace {

std::shared_ptr<const MeshHierarchy> share(const HierarchyCase& c) {
  return std::make_shared<const MeshHierarchy>(c.hierarchy);
}

ViewParameters random_view(const MeshHierarchy& h, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  ViewParameters view;
  view.camera = random_camera(h, random);
  view.camera.up = normalized(Vec3d{unit(random), unit(random), unit(random)});
  view.degrees = random() % 2 == 0 ? 0 : 5;
  view.coarse_outside = random() % 4 != 0;
  view.coarse_backfaces = random() % 2 == 0;
  view.silhouette_weight = random() % 2 == 0 ? 1 : 2;
  view.consistent = random() % 3 == 0;
  if (random() % 4 == 0) view.max_triangles = random() % 200;
  return view;
}

void check_copies(const HierarchyCase& c, int view_count, std::uint64_t seed) {
  AdaptiveMesh mesh(share(c));
  RendererCopy copy(mesh.draw_list());
  std::mt19937_64 random(seed);
  for (int i = 0; i < view_count; ++i) {
    CAPTURE(i);
    if (random() % 4 == 0) {
      mesh.set_error(random() % 3 == 0 ? -1 : float(std::exp(double(random() % 10) - 9)));
    } else {
      mesh.update(random_view(c.hierarchy, random));
    }
    copy.fetch(mesh.draw_list(), mesh.changes());
    const std::string different = copy.difference(mesh.draw_list());
    REQUIRE_MESSAGE(different.empty(), different);
  }
}

TEST_CASE("copies that fetch only the changed ranges equal the draw list") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 60); ++seed) {
    CAPTURE(seed);
    check_copies(random_case(random_complex(seed, 24, 80), {.seed = seed}), 30, seed);
  }
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 3000)) continue;
    CAPTURE(z.name);
    check_copies(simplified_case(z.mesh), 20, 3);
  }
}

void check_draw_list(const AdaptiveMesh& mesh) {
  const Mesh shown = mesh.extract();
  REQUIRE(check_mesh(shown).ok());
  const std::vector<std::string> expected = shown_triangles(shown, mesh.hierarchy().vertices.grid);
  const std::vector<std::string> got = shown_triangles(mesh.draw_list());
  REQUIRE(got.size() == mesh.triangle_count());
  REQUIRE(expected == got);
}

TEST_CASE("the draw list shows what extract() returns") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 40); ++seed) {
    CAPTURE(seed);
    const HierarchyCase c = random_case(random_complex(seed, 20, 60), {.seed = seed});
    AdaptiveMesh mesh(share(c));
    std::mt19937_64 random(seed);
    for (int i = 0; i < 20; ++i) {
      mesh.update(random_view(c.hierarchy, random));
      check_draw_list(mesh);
    }
  }
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > 3000) continue;
    CAPTURE(z.name);
    const HierarchyCase c = simplified_case(z.mesh);
    AdaptiveMesh mesh(share(c));
    std::mt19937_64 random(1);
    for (int i = 0; i < 6; ++i) {
      mesh.update(random_view(c.hierarchy, random));
      check_draw_list(mesh);
    }
  }
}

// Corner by corner, through the order of the hierarchy's triangles.
void check_full(const HierarchyCase& c, const Mesh& got) {
  REQUIRE(got.triangle_count() == c.mesh.triangle_count());
  std::map<std::uint32_t, std::uint32_t> vertex;
  for (std::size_t t = 0; t < c.mesh.triangle_count(); ++t) {
    const std::size_t n = index_of(c.maps.new_of_triangle[t]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = index_of(c.mesh.triangles[t][k]);
      const auto w = static_cast<std::uint32_t>(index_of(got.triangles[n][k]));
      REQUIRE(vertex.try_emplace(static_cast<std::uint32_t>(v), w).first->second == w);
      REQUIRE(c.mesh.positions[v] == got.positions[w]);
      for (std::size_t l = 0; l < c.mesh.layers.size(); ++l) {
        const auto expected = c.mesh.layers[l].value(c.mesh.layers[l].of_corner[3 * t + k]);
        const auto value = got.layers[l].value(got.layers[l].of_corner[3 * n + k]);
        REQUIRE(std::memcmp(expected.data(), value.data(), value.size_bytes()) == 0);
      }
    }
    if (!c.mesh.material_of_triangle.empty()) {
      REQUIRE(got.material_of_triangle[n] == c.mesh.material_of_triangle[t]);
    }
  }
  REQUIRE(vertex.size() == got.vertex_count());
}

TEST_CASE("full refinement restores the snapped input, corner for corner, from any cut") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 3000)) continue;
    CAPTURE(z.name);
    for (const HierarchyCase& c : {simplified_case(z.mesh), random_case(z.mesh, {.seed = 2})}) {
      AdaptiveMesh mesh(share(c));
      std::mt19937_64 random(1);
      const std::vector<std::string> coarsest = shown_triangles(mesh.draw_list());
      for (int i = 0; i < 3; ++i) {
        mesh.update(random_view(c.hierarchy, random));
        mesh.set_error(-1);
        check_full(c, mesh.extract());
        CHECK(mesh.error().surface == 0);
      }
      mesh.set_error(std::numeric_limits<float>::infinity());
      CHECK(shown_triangles(mesh.draw_list()) == coarsest);
    }
  }
}

TEST_CASE("real models are restored by full refinement, and copies follow what changes") {
  for (const ZooMesh& z : real_meshes(kSanitized ? 500 : 20'000)) {
    CAPTURE(z.name);
    const HierarchyCase c = simplified_case(z.mesh);
    check_copies(c, 6, 5);
    AdaptiveMesh mesh(share(c));
    std::mt19937_64 random(6);
    for (int i = 0; i < 2; ++i) {
      mesh.update(random_view(c.hierarchy, random));
      check_draw_list(mesh);
      mesh.set_error(-1);
      check_full(c, mesh.extract());
    }
  }
}

TEST_CASE("a mesh without normals shows its triangles' own") {
  Mesh plain = hard_box(2);
  const std::size_t triangle_count = plain.triangle_count();
  plain.layers.clear();
  const HierarchyCase c = random_case(std::move(plain), {.seed = 1});
  AdaptiveMesh mesh(share(c));
  mesh.set_error(-1);
  const DrawList list = mesh.draw_list();
  CHECK(list.fn.triangle_count() == triangle_count);
  CHECK(std::all_of(list.fn.normals.begin(), list.fn.normals.end(),
                    [](const Vec3f& n) { return std::fabs(length(n) - 1) < 1e-5f; }));
}

}  // namespace
}  // namespace crease
