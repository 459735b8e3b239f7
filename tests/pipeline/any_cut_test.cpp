// The hierarchy beside the plain definition of a cut, over random cuts.
#include "pipeline/hierarchy_case.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

namespace crease {
namespace {

bool passes(const HierarchyCase& c) {
  const Status status = check_hierarchy(c.hierarchy);
  CHECK_MESSAGE(status.ok(), (status.ok() ? "" : status.failure().message));
  return status.ok();
}

void check_cuts(const HierarchyCase& c, int cut_count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (int i = 0; i < cut_count; ++i) {
    const std::string different = difference_at_cut(c, random_cut(c, random));
    if (different.empty()) continue;
    CAPTURE(i);
    CHECK_MESSAGE(different.empty(), different);
    return;
  }
}

void check_levels(const HierarchyCase& c, std::size_t level_count) {
  const std::size_t count = c.sequence.contractions.size();
  for (std::size_t i = 0; i <= level_count; ++i) {
    const std::size_t applied = count * i / level_count;
    const std::string different = difference_at_level(c, applied);
    if (different.empty()) continue;
    CAPTURE(applied);
    CHECK_MESSAGE(different.empty(), different);
    return;
  }
}

TEST_CASE("any cut of a random complex is that of the plain definition") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 20 : 200); ++seed) {
    CAPTURE(seed);
    const Placement placement = seed % 2 == 0 ? Placement::Endpoint : Placement::Optimal;
    const HierarchyCase c = random_case(random_complex(seed, 5 + seed % 20, 4 + (seed * 7) % 60),
                                        {.seed = seed,
                                         .placement = placement,
                                         .virtual_share = double(seed % 5) / 4,
                                         .change_share = double(seed % 3) / 2});
    if (!passes(c)) return;
    check_levels(c, std::max<std::size_t>(1, c.sequence.contractions.size()));
    check_cuts(c, 50, seed);
  }
}

TEST_CASE("any cut of a zoo mesh is that of the plain definition, however it was contracted") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (kSanitized && z.mesh.triangle_count() > 400) continue;
    CAPTURE(z.name);
    for (Placement placement : {Placement::Endpoint, Placement::Optimal}) {
      for (const HierarchyCase& c : {random_case(z.mesh, {.seed = 11, .placement = placement}),
                                     simplified_case(z.mesh, placement)}) {
        if (!passes(c)) return;
        check_levels(c, 12);
        check_cuts(c, 20, 5);
      }
    }
  }
}

}  // namespace
}  // namespace crease
