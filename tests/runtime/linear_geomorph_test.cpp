// Geomorphs of a progressive mesh: no change of level is seen when it is made, and in the end the
// arrays are those without.
#include "crease/progressive_mesh.h"
#include "runtime/renderer_copy.h"
#include "runtime/seen_triangles.h"
#include "support/level_equality.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <random>

namespace crease {
namespace {

constexpr double kOnTheWay = 0.25;

struct Walk {
  explicit Walk(ProgressiveArraysPtr given)
      : arrays(std::move(given)), mesh(arrays), copy(mesh.draw_list()) {
    mesh.set_geomorph_seconds(kOnTheWay);
  }
  void fetch() {
    copy.fetch(mesh.draw_list(), mesh.changes());
    const std::string different = copy.difference(mesh.draw_list());
    REQUIRE_MESSAGE(different.empty(), different);
  }
  // Asks for a level: nothing looks different.
  void want(std::size_t applied) {
    const std::vector<SeenTriangle> before = seen(mesh.draw_list(), true);
    mesh.set_applied(applied);
    REQUIRE((seen(mesh.draw_list(), true) == before));
    fetch();
  }
  void advance(double seconds) {
    mesh.advance(seconds);
    fetch();
  }
  void settle(std::size_t applied) {
    for (int i = 0; mesh.is_moving(); ++i) {
      REQUIRE(i < 5);
      advance(kOnTheWay);
    }
    REQUIRE(mesh.applied() == applied);
    ProgressiveMesh plain(arrays);
    plain.set_applied(applied);
    REQUIRE(shown_triangles(mesh.draw_list()) == shown_triangles(plain.draw_list()));
  }

  ProgressiveArraysPtr arrays;
  ProgressiveMesh mesh;
  RendererCopy copy;
};

void check_linear_walk(const Mesh& mesh, const RandomContractionOptions& options) {
  Walk walk(make_case(mesh, options).arrays);
  const std::size_t count = walk.mesh.contraction_count();
  std::mt19937_64 random(options.seed);
  for (int i = 0; i < 30; ++i) {
    CAPTURE(i);
    const std::size_t wanted = random() % (count + 1);
    walk.want(wanted);
    const int steps = int(random() % 4);
    for (int k = 0; k < steps; ++k) walk.advance(kOnTheWay * double(random() % 100) / 150);
    if (random() % 2 == 0) walk.settle(wanted);
  }
}

TEST_CASE("no level is seen to come or go, and in the end it is as without geomorphs") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 40); ++seed) {
    CAPTURE(seed);
    const Placement placement = seed % 2 == 0 ? Placement::Endpoint : Placement::Optimal;
    check_linear_walk(random_complex(seed, 24, 80), {.seed = seed, .placement = placement});
  }
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 3000)) continue;
    CAPTURE(z.name);
    check_linear_walk(z.mesh, {.seed = 4});
    check_linear_walk(z.mesh, {.seed = 5, .placement = Placement::Endpoint});
  }
}

}  // namespace
}  // namespace crease
