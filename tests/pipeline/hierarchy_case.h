// Hierarchies of test meshes, and cuts through them by the plain definition.
//
//   HierarchyCase c = random_case(mesh, {.seed = 7});
//   Cut cut = random_cut(c, random);
//   CHECK(difference_at_cut(c, cut) == "");
#pragma once

#include "crease/build_hierarchy.h"
#include "crease/contraction.h"
#include "crease/mesh_hierarchy.h"
#include "support/mesh_zoo.h"
#include "support/random_contractions.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace crease {

struct HierarchyCase {
  Mesh mesh;  // snapped
  ContractionSequence sequence;
  MeshHierarchy hierarchy;
  HierarchyMaps maps;
  // Vertices by birth: the input's, then v_s of each contraction; kNone for roots.
  std::vector<std::uint32_t> parent_of_birth;
};

// Snapped to 12 bits and contracted at random, or simplified as the build does.
HierarchyCase random_case(Mesh mesh, const RandomContractionOptions& options);
HierarchyCase simplified_case(Mesh mesh, Placement placement = Placement::Optimal);
HierarchyCase case_of(Mesh snapped, ContractionSequence sequence);

// Models of ../shared/data, of every kind, that have at most so many triangles: those that are
// there.
std::vector<ZooMesh> real_meshes(std::size_t most_triangles);

// Which contractions are merged: all below a merged one are, too.
using Cut = std::vector<bool>;

Cut linear_cut(const HierarchyCase& c, std::size_t applied);
// Around the linear level of a random length: some contractions of it are undone, some others done.
Cut random_cut(const HierarchyCase& c, std::mt19937_64& random);

// The active ancestor of an input vertex, as a birth, by walking up.
std::uint32_t active_birth(const HierarchyCase& c, const Cut& cut, VertexId leaf);
NodeId node_of_birth(const HierarchyCase& c, std::uint32_t birth);

// What the hierarchy shows at a cut, triangle by triangle of the input.
struct CutTriangle {
  bool is_active = false;
  NodeId nodes[3];
};
CutTriangle triangle_at_cut(const HierarchyCase& c, const Cut& cut, TriangleId t);
StoredValue value_at_cut(const HierarchyCase& c, const CutTriangle& triangle, std::size_t layer,
                         TriangleId t, std::size_t corner);

// Empty if every triangle is active iff its leaf corners' active ancestors differ, stands at them,
// and every attribute is the one found by walking up from the leaf.
std::string difference_at_cut(const HierarchyCase& c, const Cut& cut);

// Empty if the cut of so many contractions shows the values of apply_contractions() at every corner
// of a triangle that shows its stored values.
std::string difference_at_level(const HierarchyCase& c, std::size_t applied);

}  // namespace crease
