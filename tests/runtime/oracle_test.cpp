#include "crease/progressive_mesh.h"
#include "support/level_equality.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <random>

namespace crease {
namespace {

// Every level forwards and backwards, then random jumps.
void check_all_levels(const Case& c, std::uint64_t seed) {
  const Status valid = check_contractions(c.mesh, c.sequence);
  REQUIRE_MESSAGE(valid.ok(), (valid.ok() ? "" : valid.failure().message));
  const Status sound = check_progressive_arrays(*c.arrays);
  REQUIRE_MESSAGE(sound.ok(), (sound.ok() ? "" : sound.failure().message));

  const std::size_t count = c.sequence.contractions.size();
  std::vector<Level> levels;
  for (std::size_t n = 0; n <= count; ++n) {
    levels.push_back(apply_contractions(c.mesh, c.sequence, n));
  }
  ProgressiveMesh pm(c.arrays);
  REQUIRE(pm.contraction_count() == count);
  const auto check = [&](std::size_t n) {
    pm.set_applied(n);
    const std::string different = difference(c, pm, levels[n]);
    if (different.empty()) return true;
    CAPTURE(n);
    CHECK_MESSAGE(false, different);
    return false;
  };
  for (std::size_t n = 0; n <= count; ++n) REQUIRE(check(n));
  for (std::size_t n = count + 1; n-- > 0;) REQUIRE(check(n));
  std::mt19937_64 random(seed);
  for (int jump = 0; jump < 40; ++jump) REQUIRE(check(random() % (count + 1)));
}

TEST_CASE("every level of every zoo mesh is that of the plain simulation") {
  for (const ZooMesh& z : mesh_zoo()) {
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      CAPTURE(z.name);
      CAPTURE(static_cast<int>(placement));
      if (z.mesh.triangle_count() > (kSanitized ? 150 : 400)) continue;  // simulated quadratically
      check_all_levels(make_case(z.mesh, {.seed = 11, .placement = placement}), 1);
    }
  }
}

TEST_CASE("every level of a random complex is that of the plain simulation") {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const Placement placement = seed % 2 == 0 ? Placement::Endpoint : Placement::Optimal;
    Mesh mesh = random_complex(seed, 5 + seed % 20, 4 + (seed * 7) % 60);
    // Layers in another order: the normals come first when they come out.
    check_all_levels(make_case(std::move(mesh), {.seed = seed,
                                                 .placement = placement,
                                                 .virtual_share = double(seed % 5) / 4,
                                                 .change_share = double(seed % 3) / 2}),
                     seed);
  }
}

TEST_CASE("sequences that only join keep smooth meshes smooth") {
  for (const Mesh& mesh : {smooth_sphere(8, 8), height_field(6)}) {
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      const Case c = make_case(
          mesh, {.seed = 2, .placement = placement, .derive_share = 0, .smooth_only = true});
      CHECK(c.arrays->full.fn_triangles == 0);
      CHECK(c.arrays->full.nsn_triangles == 0);
      check_all_levels(c, 3);
    }
  }
}

TEST_CASE("normals need not be the first layer") {
  Mesh mesh = random_complex(5, 12, 30);
  std::swap(mesh.layers[0], mesh.layers[2]);
  const Case c = make_case(std::move(mesh), {.seed = 5});
  ProgressiveMesh pm(c.arrays);
  for (std::size_t n = 0; n <= pm.contraction_count(); ++n) {
    pm.set_applied(n);
    Mesh expected = mesh_of_level(c.mesh, c.sequence, apply_contractions(c.mesh, c.sequence, n));
    const Mesh got = pm.extract();
    REQUIRE(got.layers.size() == 4);
    CHECK(got.layers[0].role == AttributeRole::Normal);
    CHECK(got.layers[1].name == expected.layers[0].name);
    CHECK(got.layers[2].name == expected.layers[1].name);
    CHECK(got.layers[3].name == expected.layers[3].name);
    CHECK(got.triangle_count() == expected.triangle_count());
    CHECK(check_mesh(got).ok());
  }
}

}  // namespace
}  // namespace crease
