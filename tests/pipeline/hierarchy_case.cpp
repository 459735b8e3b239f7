#include "pipeline/hierarchy_case.h"

#include "crease/import.h"
#include "crease/simplify.h"
#include "hierarchy/attribute_values.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace crease {

HierarchyCase case_of(Mesh snapped, ContractionSequence sequence) {
  HierarchyCase c;
  c.mesh = std::move(snapped);
  c.sequence = std::move(sequence);
  c.hierarchy = *build_hierarchy(c.mesh, c.sequence, {}, &c.maps);
  const std::size_t leaves = c.mesh.vertex_count();
  std::vector<std::uint32_t> birth_of_slot(leaves);
  for (std::uint32_t v = 0; v < leaves; ++v) birth_of_slot[v] = v;
  c.parent_of_birth.assign(leaves + c.sequence.contractions.size(), kNone);
  for (std::uint32_t i = 0; i < c.sequence.contractions.size(); ++i) {
    const auto birth = static_cast<std::uint32_t>(leaves + i);
    for (VertexId v : {c.sequence.contractions[i].removed, c.sequence.contractions[i].kept}) {
      c.parent_of_birth[birth_of_slot[index_of(v)]] = birth;
      birth_of_slot[index_of(v)] = birth;
    }
  }
  return c;
}

HierarchyCase random_case(Mesh mesh, const RandomContractionOptions& options) {
  const Grid grid = make_grid(mesh, {.bits = 12});
  snap(mesh, grid);
  ContractionSequence sequence = random_contractions(mesh, grid, options);
  return case_of(std::move(mesh), std::move(sequence));
}

HierarchyCase simplified_case(Mesh mesh, Placement placement) {
  const Grid grid = make_grid(mesh, {.bits = 20});
  snap(mesh, grid);
  SimplifyOptions options;
  options.placement = placement;
  options.threads = 1;
  ContractionSequence sequence = *simplify(mesh, grid, options);
  return case_of(std::move(mesh), std::move(sequence));
}

std::vector<ZooMesh> real_meshes(std::size_t most_triangles) {
  std::vector<ZooMesh> meshes;
  for (const char* name :
       {"cad/fandisk.off", "cad/hoppe_cessna.obj.zst", "cad/hoppe_golf_club.obj.zst",
        "attributes/pirate.obj.zst", "attributes/corset.glb", "attributes/materials_7.obj.zst",
        "attributes/cow_viewpoint.obj.zst", "nasty/topology_bunny_nonmanifold_ascii.ply",
        "nasty/topology_moebius.obj", "nasty/topology_many_on_edges.obj",
        "nasty/topology_everything_twice.obj", "nasty/topology_touching_solids.obj",
        "nasty/topology_three_on_an_edge.obj", "nasty/degenerate_faces.obj",
        "nasty/orientation_mixed.stl", "nasty/topology_soup.stl"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty()) continue;
    Result<Imported> in = import_mesh(path, {});
    if (!in.ok()) FAIL(name, ": ", in.failure().message);
    if (in->mesh.triangle_count() <= most_triangles) meshes.push_back({name, std::move(in->mesh)});
  }
  return meshes;
}

Cut linear_cut(const HierarchyCase& c, std::size_t applied) {
  Cut cut(c.sequence.contractions.size(), false);
  std::fill_n(cut.begin(), applied, true);
  return cut;
}

Cut random_cut(const HierarchyCase& c, std::mt19937_64& random) {
  const std::size_t count = c.sequence.contractions.size(), leaves = c.mesh.vertex_count();
  const std::size_t middle = random() % (count + 1);
  const std::size_t undone_of_64 = random() % 16, done_of_64 = random() % 64;
  Cut cut(count, true);
  for (std::size_t i = 0; i < count; ++i) {
    // What lies below was decided before: an undone child has undone this one.
    if (cut[i]) cut[i] = random() % 64 < (i < middle ? 64 - undone_of_64 : done_of_64);
    const std::uint32_t parent = c.parent_of_birth[leaves + i];
    if (!cut[i] && parent != kNone) cut[parent - leaves] = false;
  }
  return cut;
}

std::uint32_t active_birth(const HierarchyCase& c, const Cut& cut, VertexId leaf) {
  auto birth = static_cast<std::uint32_t>(index_of(leaf));
  while (c.parent_of_birth[birth] != kNone &&
         cut[c.parent_of_birth[birth] - c.mesh.vertex_count()]) {
    birth = c.parent_of_birth[birth];
  }
  return birth;
}

NodeId node_of_birth(const HierarchyCase& c, std::uint32_t birth) {
  if (birth < c.mesh.vertex_count()) return c.maps.leaf_of_vertex[birth];
  const SplitId split = c.maps.split_of_contraction[birth - c.mesh.vertex_count()];
  return c.hierarchy.vertices.node_of_split[index_of(split)];
}

namespace {

// Per split, whether it is done at a cut.
std::vector<bool> done_splits(const HierarchyCase& c, const Cut& cut) {
  std::vector<bool> done(cut.size());
  for (std::size_t i = 0; i < cut.size(); ++i) {
    done[index_of(c.maps.split_of_contraction[i])] = !cut[i];
  }
  return done;
}

// Per triangle the split that introduces it, or kNoSplit.
std::vector<SplitId> introducing_splits(const VertexHierarchy& h) {
  std::vector<SplitId> of_triangle(h.triangles.size(), kNoSplit);
  for (std::uint32_t s = 0; s < h.split_count(); ++s) {
    const TriangleRange range = h.triangles_of(SplitId{s});
    for (std::uint32_t t = range.begin; t < range.end; ++t) of_triangle[t] = SplitId{s};
  }
  return of_triangle;
}

NodeId descend(const VertexHierarchy& h, const std::vector<bool>& done, WedgeId wedge) {
  NodeId n = h.root_of(wedge);
  for (SplitId s = h.split_of(n); s != kNoSplit && done[index_of(s)]; s = h.split_of(n)) {
    n = h.child(s, h.goes_to_second(s, wedge));
  }
  return n;
}

// From the leaf, step by step.
RelativeAttribute walked_up(const HierarchyCase& c, std::size_t layer, NodeId leaf, NodeId to,
                            WedgeId wedge) {
  const MeshHierarchy& h = c.hierarchy;
  RelativeAttribute a = h.at_leaf(layer, leaf, wedge);
  for (NodeId n = leaf; n != to; n = h.vertices.parent(n)) {
    a = h.above(layer, h.vertices.split_above(n), h.vertices.is_second(n), a, wedge);
  }
  return a;
}

}  // namespace

CutTriangle triangle_at_cut(const HierarchyCase& c, const Cut& cut, TriangleId t) {
  const VertexHierarchy& h = c.hierarchy.vertices;
  const TriangleId n = c.maps.new_of_triangle[index_of(t)];
  CutTriangle result;
  const std::vector<bool> done = done_splits(c, cut);
  const SplitId split = introducing_splits(h)[index_of(n)];
  result.is_active = split == kNoSplit || done[index_of(split)];
  for (std::size_t k = 0; k < 3; ++k) {
    result.nodes[k] = descend(h, done, h.triangles[index_of(n)][k]);
  }
  return result;
}

StoredValue value_at_cut(const HierarchyCase& c, const CutTriangle& triangle, std::size_t layer,
                         TriangleId t, std::size_t corner) {
  const MeshHierarchy& h = c.hierarchy;
  const TriangleId n = c.maps.new_of_triangle[index_of(t)];
  const WedgeId wedge = h.vertices.triangles[index_of(n)][corner];
  const NodeId node = triangle.nodes[corner];
  return h.value(layer, node, h.attribute_at(layer, node, wedge));
}

std::string difference_at_cut(const HierarchyCase& c, const Cut& cut) {
  const VertexHierarchy& h = c.hierarchy.vertices;
  const std::vector<bool> done = done_splits(c, cut);
  const std::vector<SplitId> introducing = introducing_splits(h);
  for (std::uint32_t t = 0; t < c.mesh.triangle_count(); ++t) {
    const std::string at = " of triangle " + std::to_string(t);
    const Triangle& triangle = c.mesh.triangles[t];
    std::uint32_t births[3];
    for (std::size_t k = 0; k < 3; ++k) births[k] = active_birth(c, cut, triangle[k]);
    const bool alive = births[0] != births[1] && births[1] != births[2] && births[2] != births[0];
    const std::size_t n = index_of(c.maps.new_of_triangle[t]);
    const SplitId split = introducing[n];
    if (alive != (split == kNoSplit || done[index_of(split)])) return "activity" + at;
    if (!alive) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const WedgeId wedge = h.triangles[n][k];
      const NodeId node = descend(h, done, wedge);
      if (node != node_of_birth(c, births[k])) return "vertex" + at;
      for (std::size_t l = 0; l < c.hierarchy.layers.size(); ++l) {
        const RelativeAttribute a = c.hierarchy.attribute_at(l, node, wedge);
        const NodeId leaf = c.maps.leaf_of_vertex[index_of(triangle[k])];
        if (a >= c.hierarchy.layers[l].attribute_count(node)) return "missing attribute" + at;
        if (a != walked_up(c, l, leaf, node, wedge)) return "attribute" + at;
      }
    }
  }
  return {};
}

std::string difference_at_level(const HierarchyCase& c, std::size_t applied) {
  const Level level = apply_contractions(c.mesh, c.sequence, applied);
  const VertexHierarchy& h = c.hierarchy.vertices;
  const std::vector<bool> done = done_splits(c, linear_cut(c, applied));
  const std::vector<SplitId> introducing = introducing_splits(h);
  for (std::uint32_t t = 0; t < c.mesh.triangle_count(); ++t) {
    const std::string at = " of triangle " + std::to_string(t);
    const std::size_t n = index_of(c.maps.new_of_triangle[t]);
    const SplitId split = introducing[n];
    if (level.alive[t] != (split == kNoSplit || done[index_of(split)])) return "activity" + at;
    if (!level.alive[t]) continue;
    const SplitId deriving = h.deriving_split(TriangleId{static_cast<std::uint32_t>(n)});
    const bool derived = deriving != kNoSplit && !done[index_of(deriving)];
    if (level.derived[t] != derived) return "derived or not" + at;
    for (std::size_t k = 0; k < 3; ++k) {
      const WedgeId wedge = h.triangles[n][k];
      const NodeId node = descend(h, done, wedge);
      if (h.position_of(node) != level.positions[index_of(level.triangles[t][k])]) {
        return "position" + at;
      }
      for (std::size_t l = 0; l < c.mesh.layers.size(); ++l) {
        if (derived && c.mesh.layers[l].role == AttributeRole::Normal) continue;
        const auto got = c.hierarchy.value(l, node, c.hierarchy.attribute_at(l, node, wedge));
        const auto expected =
            attribute_value(c.mesh.layers[l], c.sequence, l, level.of_corner[l][3 * t + k]);
        if (std::memcmp(got.begin(), expected.data(), expected.size_bytes()) != 0) {
          return c.mesh.layers[l].name + at;
        }
      }
    }
  }
  return {};
}

}  // namespace crease
