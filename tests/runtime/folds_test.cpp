// Cuts that are unfolded, beside a look at every triangle of what they extract.
#include "crease/adaptive_mesh.h"
#include "crease/build_hierarchy.h"
#include "pipeline/hierarchy_case.h"
#include "runtime/random_camera.h"
#include "runtime/renderer_copy.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace crease {
namespace {

// Triangles with an area that face away from what all their corners show, by a degree or more.
std::size_t folds_of(const Mesh& mesh) {
  const AttributeLayer* const normals = mesh.normals();
  std::size_t count = 0;
  for (std::size_t t = 0; normals != nullptr && t < mesh.triangle_count(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Vec3d& p = mesh.positions[index_of(a)];
    const Vec3d plane =
        normalized(cross(mesh.positions[index_of(b)] - p, mesh.positions[index_of(c)] - p));
    bool is_fold = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto n = normals->value(normals->of_corner[3 * t + k]);
      is_fold = is_fold && dot(plane, Vec3d{n[0], n[1], n[2]}) < -0.021;
    }
    count += is_fold;
  }
  return count;
}

// A box whose top is a fine grid with a hill in one corner: a view of the hill splits some of what
// is flat, and leaves the rest.
Mesh hill_on_a_plain() {
  Mesh mesh;
  constexpr std::uint32_t kSide = 48;
  for (std::uint32_t y = 0; y <= kSide; ++y) {
    for (std::uint32_t x = 0; x <= kSide; ++x) {
      const double far = std::min(1.0, ((x - 9.0) * (x - 9.0) + (y - 9.0) * (y - 9.0)) / 40);
      mesh.positions.push_back({double(x), double(y), 3 * (1 - far) * (1 - far)});
    }
  }
  const auto at = [](std::uint32_t x, std::uint32_t y) { return VertexId{y * (kSide + 1) + x}; };
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 0; x < kSide; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  AttributeLayer up{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {0, 0, 1}, {}};
  up.of_corner.assign(3 * mesh.triangle_count(), AttributeId{0});
  mesh.layers.push_back(std::move(up));
  return mesh;
}

struct Seen {
  std::size_t folded = 0;    // triangles in all views before
  std::size_t unfolded = 0;  // of models that are sound themselves, after
};

Seen look(const HierarchyCase& c, std::uint64_t seed, int views) {
  const std::vector<char> faces_away = triangles_facing_away(c.mesh, c.maps);
  const bool is_sound = std::ranges::count(faces_away, 0) == std::ptrdiff_t(faces_away.size());
  AdaptiveMesh mesh(std::make_shared<const MeshHierarchy>(c.hierarchy));
  RendererCopy copy(mesh.draw_list());
  std::mt19937_64 random(seed);
  Seen seen;
  for (int i = 0; i < views; ++i) {
    CAPTURE(i);
    ViewParameters view;
    view.camera = random_camera(c.hierarchy, random);
    view.hysteresis = 1;
    mesh.update(view);
    copy.fetch(mesh.draw_list(), mesh.changes());
    const std::size_t before = folds_of(mesh.extract()), triangles = mesh.triangle_count();
    mesh.unfold(triangles, faces_away);
    CHECK(mesh.triangle_count() <= triangles);
    copy.fetch(mesh.draw_list(), mesh.changes());
    const std::size_t left = mesh.unfold(std::numeric_limits<std::size_t>::max(), faces_away);
    copy.fetch(mesh.draw_list(), mesh.changes());
    const std::string different = copy.difference(mesh.draw_list());
    REQUIRE_MESSAGE(different.empty(), different);
    seen.folded += before;
    if (is_sound) {
      CHECK(left == 0);
      seen.unfolded += folds_of(mesh.extract());
    }
    // What a view needs does not depend on it.
    mesh.update(view);
    copy.fetch(mesh.draw_list(), mesh.changes());
    CHECK(mesh.triangle_count() == triangles);
  }
  return seen;
}

TEST_CASE("views leave flat surfaces folded over in places, and unfolded they are not") {
  Seen all;
  const auto add = [&all](const Seen& seen) {
    all.folded += seen.folded;
    all.unfolded += seen.unfolded;
  };
  add(look(simplified_case(hill_on_a_plain()), 1, 60));
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 3000)) continue;
    CAPTURE(z.name);
    add(look(simplified_case(z.mesh), 2, kSanitized ? 4 : 12));
  }
  CHECK(all.folded > 0);  // how many is the machine's: its sine rounds some models' last bits
  CHECK(all.unfolded == 0);
}

}  // namespace
}  // namespace crease
