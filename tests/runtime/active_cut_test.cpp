// The moves of a cut beside the plain definition of cuts.
#include "runtime/cut_oracle.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

namespace crease {
namespace {

bool agrees(const CutOracle& oracle, const ActiveCut& cut) {
  const std::string different = difference(oracle, cut);
  CHECK_MESSAGE(different.empty(), different);
  return different.empty();
}

void check_walks(const HierarchyCase& c, int walk_count, std::uint64_t seed) {
  CutOracle oracle(c);
  ActiveCut cut(c.hierarchy);
  if (!agrees(oracle, cut)) return;
  std::mt19937_64 random(seed);
  for (int i = 0; i < walk_count; ++i) {
    CAPTURE(i);
    oracle.set(random_cut(c, random));
    walk_to(oracle, cut, random);
    if (!agrees(oracle, cut)) return;
  }
}

// Of all corners that stand at vertices of the cut with several attributes.
void check_order(const MeshHierarchy& hierarchy, const ActiveCut& cut, std::size_t& compared) {
  for (std::size_t l = 0; l < hierarchy.layers.size(); ++l) {
    const AttributeHierarchy& layer = hierarchy.layers[l];
    const AttributeOrder order(hierarchy, l);
    for (std::uint32_t slot = 0; slot < cut.vertices().size(); ++slot) {
      const NodeId node = cut.vertices()[slot].node;
      if (node == kNoNode || layer.attribute_count(node) < 2) continue;
      for (const CornerAt at : cut.corners_of(slot)) {
        const RelativeAttribute found = order.attribute_at(order.node(layer, node), at.wedge);
        REQUIRE(found == hierarchy.attribute_at(l, node, at.wedge));
        ++compared;
      }
    }
  }
}

TEST_CASE("the order of the attribute forest tells what a walk down and up finds") {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    const HierarchyCase c = random_case(random_complex(seed, 10 + seed % 20, 20 + (seed * 7) % 60),
                                        {.seed = seed, .change_share = double(seed % 3) / 2});
    CutOracle oracle(c);
    ActiveCut cut(c.hierarchy);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 5; ++i) {
      oracle.set(random_cut(c, random));
      walk_to(oracle, cut, random);
      check_order(c.hierarchy, cut, compared);
    }
  }
  CHECK(compared > 1000);
}

TEST_CASE("a random walk between cuts of a random complex shows what the plain definition says") {
  for (std::uint64_t seed = 0; seed < (kSanitized ? 20 : 200); ++seed) {
    CAPTURE(seed);
    check_walks(random_case(random_complex(seed, 5 + seed % 20, 4 + (seed * 7) % 60),
                            {.seed = seed,
                             .placement = seed % 2 == 0 ? Placement::Endpoint : Placement::Optimal,
                             .virtual_share = double(seed % 5) / 4,
                             .change_share = double(seed % 3) / 2}),
                20, seed);
  }
}

TEST_CASE("a random walk between cuts of a zoo mesh shows what the plain definition says") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > (kSanitized ? 200 : 800)) continue;
    CAPTURE(z.name);
    check_walks(random_case(z.mesh, {.seed = 3}), kSanitized ? 6 : 20, 1);
    check_walks(simplified_case(z.mesh), kSanitized ? 6 : 20, 2);
  }
}

TEST_CASE("a random walk between cuts of a real model shows what the plain definition says") {
  for (const ZooMesh& z : real_meshes(kSanitized ? 200 : 20'000)) {
    CAPTURE(z.name);
    const std::size_t cuts = 200'000 / (z.mesh.triangle_count() + 1000);
    check_walks(simplified_case(z.mesh), static_cast<int>(cuts), 4);
  }
}

TEST_CASE("single moves, any that are possible, keep a cut right") {
  const HierarchyCase c = random_case(random_complex(3, 30, 90), {.seed = 3});
  CutOracle oracle(c);
  ActiveCut cut(c.hierarchy);
  const VertexHierarchy& h = c.hierarchy.vertices;
  std::vector<bool> done(h.split_count(), false);
  std::mt19937_64 random(5);
  for (int move = 0; move < 2000; ++move) {
    const auto slot = static_cast<std::uint32_t>(random() % cut.vertices().size());
    const NodeId n = cut.vertices()[slot].node;
    if (n == kNoNode) continue;
    if (const SplitId s = h.split_of(n); s != kNoSplit && random() % 2 == 0) {
      cut.split(slot);
      done[index_of(s)] = true;
    } else if (!h.is_root(n) && cut.can_merge(h.split_above(n))) {
      cut.merge(h.split_above(n));
      done[index_of(h.split_above(n))] = false;
    }
    oracle.set_done(done);
    if (move % 10 == 0 && !agrees(oracle, cut)) return;
  }
}

}  // namespace
}  // namespace crease
