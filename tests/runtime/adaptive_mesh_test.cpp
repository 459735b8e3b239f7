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
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <set>

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
      mesh.set_error(std::nanf(""));
      check_full(c, mesh.extract());
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

// Where a wedge's corners stand when exactly the vertices with larger errors are split.
NodeId standing(const VertexHierarchy& h, WedgeId wedge, float error) {
  NodeId node = h.root_of(wedge);
  for (SplitId s = h.split_of(node); s != kNoSplit; s = h.split_of(node)) {
    const SplitBounds& bounds = h.bounds[index_of(s)];
    if (std::max(bounds.surface.value(), bounds.line.value()) <= error) break;
    node = h.child(s, h.goes_to_second(s, wedge));
  }
  return node;
}

std::map<NodeId, std::size_t> leaf_counts(const VertexHierarchy& h, float error) {
  std::map<NodeId, std::set<NodeId>> leaves;
  for (std::uint32_t i = 0; i < h.wedge_count(); ++i) {
    leaves[standing(h, WedgeId{i}, error)].insert(standing(h, WedgeId{i}, -1));
  }
  std::map<NodeId, std::size_t> counts;
  for (const auto& [node, below] : leaves) counts[node] = below.size();
  return counts;
}

TEST_CASE("a position's level tells how many of the input's vertices stand there") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 3000)) continue;
    CAPTURE(z.name);
    const HierarchyCase c = simplified_case(z.mesh);
    const float infinite = std::numeric_limits<float>::infinity();
    const std::map<NodeId, std::size_t> roots = leaf_counts(c.hierarchy.vertices, infinite);
    std::size_t leaf_count = 0;
    for (const auto& [root, count] : roots) leaf_count += count;
    const double mean = double(leaf_count) / double(std::max<std::size_t>(1, roots.size()));
    AdaptiveMesh mesh(share(c));
    for (const float error : {infinite, 0.3f, 0.03f, 0.0f, -1.0f}) {
      CAPTURE(error);
      mesh.set_error(error);
      std::vector<double> expected, got;
      for (const auto& [node, count] : leaf_counts(c.hierarchy.vertices, error)) {
        if (count > 1) expected.push_back(std::min(1.0, std::log(double(count)) / std::log(mean)));
      }
      for (const float level : mesh.level_of_position()) {
        if (level > 0) got.push_back(level);
      }
      CHECK(mesh.level_of_position().size() == mesh.draw_list().positions.size());
      std::sort(expected.begin(), expected.end());
      std::sort(got.begin(), got.end());
      REQUIRE(got.size() == expected.size());
      for (std::size_t i = 0; i < got.size(); ++i) CHECK(std::abs(got[i] - expected[i]) < 1e-5);
      if (error < 0) CHECK(got.empty());
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
