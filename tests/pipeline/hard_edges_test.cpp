// Edges that are hard in the input, beside all cuts there are.
#include "pipeline/hierarchy_case.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace crease {
namespace {

// Two triangles and where they have the two ends of an edge.
struct HardPair {
  TriangleId triangles[2];
  std::size_t corners[2][2];  // of the triangle at the end
  int soft_ends = 0;          // most that some cut shades across
};

std::size_t corner_at(const Triangle& t, VertexId v) {
  return std::size_t(std::find(t.begin(), t.end(), v) - t.begin());
}

std::vector<HardPair> hard_pairs(const Mesh& mesh) {
  std::vector<HardPair> pairs;
  const auto normal = [&](std::size_t t, std::size_t c) {
    return mesh.layers[0].of_corner[3 * t + c];
  };
  for (std::uint32_t a = 0; a < mesh.triangle_count(); ++a) {
    for (std::uint32_t b = a + 1; b < mesh.triangle_count(); ++b) {
      for (std::size_t c = 0; c < 3; ++c) {
        HardPair pair{{TriangleId{a}, TriangleId{b}}, {}, 0};
        bool is_hard = true;
        for (std::size_t end : {0u, 1u}) {
          const std::size_t of_a = (c + end) % 3;
          const std::size_t of_b = corner_at(mesh.triangles[b], mesh.triangles[a][of_a]);
          is_hard = is_hard && of_b < 3 && normal(a, of_a) != normal(b, of_b);
          pair.corners[0][end] = of_a;
          pair.corners[1][end] = of_b;
        }
        if (is_hard) pairs.push_back(pair);
      }
    }
  }
  return pairs;
}

bool is_cut(const HierarchyCase& c, const Cut& cut) {
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const std::uint32_t parent = c.parent_of_birth[c.mesh.vertex_count() + i];
    if (parent != kNone && cut[parent - c.mesh.vertex_count()] && !cut[i]) return false;
  }
  return true;
}

int soft_ends_at(const HierarchyCase& c, const HardPair& pair,
                 const std::vector<CutTriangle>& triangles) {
  int soft = 0;
  for (std::size_t end : {0u, 1u}) {
    RelativeAttribute attribute[2];
    for (std::size_t side : {0u, 1u}) {
      const std::size_t t = index_of(pair.triangles[side]);
      const std::size_t corner = pair.corners[side][end];
      const std::size_t n = index_of(c.maps.new_of_triangle[t]);
      attribute[side] = c.hierarchy.attribute_at(0, triangles[t].nodes[corner],
                                                 c.hierarchy.vertices.triangles[n][corner]);
    }
    soft += attribute[0] == attribute[1] ? 1 : 0;
  }
  return soft;
}

void look_at_cut(const HierarchyCase& c, const Cut& cut, std::vector<HardPair>& pairs) {
  std::vector<CutTriangle> triangles;
  for (std::uint32_t t = 0; t < c.mesh.triangle_count(); ++t) {
    triangles.push_back(triangle_at_cut(c, cut, TriangleId{t}));
  }
  for (HardPair& pair : pairs) {
    const bool both = triangles[index_of(pair.triangles[0])].is_active &&
                      triangles[index_of(pair.triangles[1])].is_active;
    if (both) pair.soft_ends = std::max(pair.soft_ends, soft_ends_at(c, pair, triangles));
  }
}

std::size_t count_with(const std::vector<HardPair>& pairs, int soft_ends) {
  return std::size_t(std::count_if(pairs.begin(), pairs.end(), [soft_ends](const HardPair& p) {
    return p.soft_ends == soft_ends;
  }));
}

TEST_CASE("hard edges are those that brute force finds over all cuts of small complexes") {
  std::size_t soft = 0;
  for (std::uint64_t seed = 0; seed < (kSanitized ? 10 : 400); ++seed) {
    CAPTURE(seed);
    const HierarchyCase c = random_case(random_complex(seed, 7 + seed % 3, 8 + seed % 12),
                                        {.seed = seed, .change_share = 0, .derive_share = 0});
    const Result<HardEdges> found = check_hard_edges(c.hierarchy);
    REQUIRE_MESSAGE(found.ok(), (found.ok() ? "" : found.failure().message));
    std::vector<HardPair> pairs = hard_pairs(c.mesh);
    const std::size_t count = c.sequence.contractions.size();
    for (std::uint32_t bits = 0; bits < (1u << count); ++bits) {
      Cut cut(count);
      for (std::size_t i = 0; i < count; ++i) cut[i] = (bits >> i & 1) != 0;
      if (is_cut(c, cut)) look_at_cut(c, cut, pairs);
    }
    REQUIRE(found->count == pairs.size());
    REQUIRE(found->soft_at_one_end == count_with(pairs, 1));
    REQUIRE(found->soft_at_both_ends == count_with(pairs, 2));
    soft += found->soft_at_one_end;
  }
  CHECK(soft > 0);
}

//        u
//      / | | \       r-p-q-s is a crease that ends at r and s: only p-q is hard at both ends.
//     r--p-q--s      r and p become one, then q and s: its triangles stay and show it no more.
//      \ | | /
//        d
TEST_CASE("a crease that is contracted from where it ends softens at that end") {
  MeshBuilder b;
  const VertexId r = b.vertex({0, 0, 0}), p = b.vertex({1, 0, 0}), q = b.vertex({2, 0, 0}),
                 s = b.vertex({3, 0, 0}), u = b.vertex({1.5, 2, 0}), d = b.vertex({1.5, -2, 0});
  const AttributeId at_r = b.normal({0, 0, 1}), at_s = b.normal({0.1, 0, 1}),
                    above = b.normal({0, 1, 1}), below = b.normal({0, -1, 1}),
                    p_above = b.normal({0.1, 1, 1}), p_below = b.normal({0.1, -1, 1}),
                    q_above = b.normal({0.2, 1, 1}), q_below = b.normal({0.2, -1, 1});
  b.triangle({r, p, u}, {at_r, p_above, above});
  b.triangle({p, q, u}, {p_above, q_above, above});
  b.triangle({q, s, u}, {q_above, at_s, above});
  b.triangle({p, r, d}, {p_below, at_r, below});
  b.triangle({q, p, d}, {q_below, p_below, below});
  b.triangle({s, q, d}, {at_s, q_below, below});
  Mesh mesh = b.take();
  ContractionSequence sequence;
  sequence.grid = make_grid(mesh, {.bits = 8});
  snap(mesh, sequence.grid);
  sequence.new_values.resize(1);
  const auto add = [&](VertexId kept, VertexId removed, std::vector<AttributeChange> changes) {
    Contraction c;
    c.kept = kept;
    c.removed = removed;
    c.position = sequence.grid.nearest(mesh.positions[index_of(kept)]);
    c.first_change = std::uint32_t(sequence.changes.size());
    c.change_count = std::uint32_t(changes.size());
    sequence.changes.insert(sequence.changes.end(), changes.begin(), changes.end());
    sequence.contractions.push_back(c);
  };
  add(r, p, {{0, p_above, at_r}, {0, p_below, at_r}});
  const Result<HardEdges> one = check_hard_edges(case_of(mesh, sequence).hierarchy);
  REQUIRE(one.ok());
  CHECK(one->count == 1);
  CHECK(one->soft_at_one_end == 1);
  add(s, q, {{0, q_above, at_s}, {0, q_below, at_s}});
  const Result<HardEdges> both = check_hard_edges(case_of(mesh, sequence).hierarchy);
  REQUIRE(both.ok());
  CHECK(both->soft_at_one_end == 0);
  CHECK(both->soft_at_both_ends == 1);
}

TEST_CASE("hard edges of simplified zoo meshes keep their sides apart at every random cut") {
  std::mt19937_64 random(4);
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() > 300) continue;
    CAPTURE(z.name);
    const HierarchyCase c = simplified_case(z.mesh);
    const Result<HardEdges> found = check_hard_edges(c.hierarchy);
    REQUIRE_MESSAGE(found.ok(), (found.ok() ? "" : found.failure().message));
    std::vector<HardPair> pairs = hard_pairs(c.mesh);
    for (int i = 0; i < (kSanitized ? 3 : 12); ++i) look_at_cut(c, random_cut(c, random), pairs);
    CHECK(found->count == pairs.size());
    CHECK(count_with(pairs, 2) <= found->soft_at_both_ends);
    CHECK(count_with(pairs, 1) <= found->soft_at_one_end + found->soft_at_both_ends);
  }
}

TEST_CASE("creases that go all the way round are hard at every cut") {
  for (const Mesh& mesh :
       {hard_box(4), crossing_walls(2, 3), hard_cylinder(16, 4), gear(8), city_blocks(3, 2)}) {
    const Result<HardEdges> found = check_hard_edges(simplified_case(mesh).hierarchy);
    REQUIRE_MESSAGE(found.ok(), (found.ok() ? "" : found.failure().message));
    CHECK(found->count > 0);
    CHECK(found->soft_at_one_end == 0);
    CHECK(found->soft_at_both_ends == 0);
  }
}

// So that a value does not follow a parent map that is harmed.
void give_own_values(MeshHierarchy& h, AttributeHierarchy& layer) {
  PackedIndices<> values(32);
  for (std::uint32_t n = 0; n < h.vertices.node_count(); ++n) {
    for (std::uint32_t a = 0; a < layer.attribute_count(NodeId{n}); ++a) {
      values.push_back(h.value_index(0, NodeId{n}, RelativeAttribute(a)));
    }
  }
  layer.value_of_attribute = values;
  layer.has_value = {};
}

// Two sides of a box become one attribute where no triangle links them.
TEST_CASE("attributes that become one across a hard edge are found") {
  HierarchyCase c = simplified_case(hard_box(3));
  give_own_values(c.hierarchy, c.hierarchy.layers[0]);
  std::size_t found_count = 0;
  for (std::uint32_t s = 0; s < c.hierarchy.vertices.split_count(); ++s) {
    const AttributeHierarchy& sound = c.hierarchy.layers[0];
    if (sound.attribute_count(c.hierarchy.vertices.node_of_split[s]) < 2) continue;
    ParentMaps changed;
    for (std::size_t k = 0; k < sound.parents_of_split.size(); ++k) {
      const ParentMaps::Map map = sound.parents_of_split.of(k);
      std::vector<RelativeAttribute> parents;
      for (std::size_t i = 0; i < map.size(); ++i) {
        parents.push_back(k == s && map[i] != kRemoved ? RelativeAttribute{0} : map[i]);
      }
      changed.push_back(parents);
    }
    MeshHierarchy harmed = c.hierarchy;
    harmed.layers[0].parents_of_split = changed;
    const Result<HardEdges> found = check_hard_edges(harmed);
    if (found.ok()) continue;  // no hard edge at v_s has both its triangles
    ++found_count;
    CHECK(found.failure().message.find("split " + std::to_string(s) + ": shades across") !=
          std::string::npos);
  }
  CHECK(found_count > 10);
}

}  // namespace
}  // namespace crease
