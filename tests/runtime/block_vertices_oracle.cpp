#include "runtime/block_vertices_oracle.h"

#include "codec/layer_values.h"
#include "hierarchy/geometric_normal.h"
#include "runtime/block_errors.h"
#include "runtime/block_mesh_impl.h"
#include "runtime/draw_values.h"
#include "runtime/view_error.h"
#include "support/described_mesh.h"
#include "support/drawn_triangles.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace crease {

namespace {

// A vertex of the union of all cuts: a node of a block's hierarchy, or a vertex of a whole block.
struct Active {
  std::uint32_t block = 0, node = 0;
  Vec3i position;
  bool operator==(const Active& other) const { return block == other.block && node == other.node; }
};

// A triangle as one block has it.
struct Place {
  std::uint32_t block = 0, triangle = 0;
};

// A block that is by vertex, or at a level between its ends.
struct OneCut {
  const ResidentBlock* resident = nullptr;
  const BlockCut* by_vertex = nullptr;
  const LevelList* list = nullptr;  // or this one,
  BlockHierarchyPtr hierarchy;      // and what it is a cut of

  const ResidentBlock& block() const { return *resident; }
  const BlockHierarchy::Data& data() const {
    return by_vertex != nullptr ? by_vertex->data() : hierarchy->data();
  }
  bool is_done(SplitId s) const {
    if (by_vertex != nullptr) return by_vertex->is_done(s);
    return (list->done[index_of(s) / 64] >> (index_of(s) % 64) & 1) != 0;
  }
};

// The lowest node that is above the leaf and not below a split that is not done.
template <typename Cut>
NodeId active_above(const Cut& cut, NodeId leaf) {
  const VertexHierarchy& h = cut.data().hierarchy.vertices;
  NodeId active = leaf;
  for (NodeId n = leaf; !h.is_root(n);) {
    const SplitId s = h.split_above(n);
    n = h.node_of_split[index_of(s)];
    if (!cut.is_done(s)) active = n;
  }
  return active;
}

class BlocksOracle {
 public:
  explicit BlocksOracle(const BlockMesh::Impl& mesh) : mesh_(mesh) {
    for (const std::uint32_t block : mesh_.cut) {
      find_sources(block);
      find_cut(block);
    }
  }

  Mesh run() {
    result_.materials = mesh_.schema->materials;
    result_.parts = mesh_.part_names;
    for (const LayerSchema& layer : mesh_.schema->facts.layers) {
      result_.layers.push_back({.name = layer.name,
                                .role = layer.role,
                                .interpolation = layer.interpolation,
                                .dimension = layer.dimension,
                                .values = {},
                                .of_corner = {}});
    }
    for (const std::uint32_t block : mesh_.cut) {
      if (!is_refined(block)) continue;
      const KeptEnd& end = data(block).end;
      for (std::uint32_t t = 0; t < end.triangle_count(); ++t) {
        const std::uint32_t finer = mesh_.graph.next_finer(band(block), end.label(t));
        if (!is_refined(finer)) add({block, t});
      }
    }
    return std::move(result_);
  }

 private:
  const ResidentBlock::Data& data(std::uint32_t block) const {
    return mesh_.resident[block]->data();
  }
  std::uint16_t band(std::uint32_t block) const { return data(block).entry.facts.band; }
  bool is_refined(std::uint32_t block) const {
    return block != kNone && mesh_.levels.shown(block) > 0;
  }

  void find_cut(std::uint32_t block) {
    OneCut cut{mesh_.resident[block].get(), mesh_.cuts.cut(block), mesh_.levels.list(block), {}};
    if (cut.by_vertex == nullptr && cut.list == nullptr) return;
    if (cut.by_vertex == nullptr) {
      std::vector<ResidentBlockPtr> needed;
      for (const std::uint32_t n : mesh_.graph.dependencies(block)) {
        needed.push_back(mesh_.resident[n]);
      }
      cut.hierarchy = make_tall_hierarchy(*mesh_.resident[block], needed);
    }
    cuts_.emplace(block, std::move(cut));
  }
  // Null: the block is shown whole.
  const OneCut* cut_of(std::uint32_t block) const {
    const auto at = cuts_.find(block);
    return at == cuts_.end() ? nullptr : &at->second;
  }

  // Per triangle of its coarse end, where it comes from.
  void find_sources(std::uint32_t block) {
    for (const std::uint32_t needed : mesh_.graph.dependencies(block)) {
      if (band(needed) != band(block) + 1) continue;
      const KeptEnd& end = data(needed).end;
      for (std::uint32_t t = 0; t < end.triangle_count(); ++t) {
        if (end.label(t) == data(block).entry.facts.patch) sources_[block].push_back({needed, t});
      }
    }
    REQUIRE(sources_[block].size() == data(block).coarse_triangles);
  }

  Active active(const codec::VertexName& name) const {
    const OneCut* const cut = cut_of(name.block);
    if (cut == nullptr) {
      return {name.block, name.vertex, data(name.block).end.position(name.vertex)};
    }
    const BlockHierarchy::Data& d = cut->data();
    const NodeId leaf = d.leaf_of_vertex[name.vertex];
    const NodeId node = d.wedge_of_vertex[name.vertex] == kNone ? leaf : active_above(*cut, leaf);
    return of_node(name.block, d, node);
  }
  Active of_node(std::uint32_t block, const BlockHierarchy::Data& d, NodeId node) const {
    const auto root = std::find(d.node_of_root.begin(), d.node_of_root.end(), node);
    if (root != d.node_of_root.end()) {
      const codec::VertexName made =
          data(block).root_names[std::size_t(root - d.node_of_root.begin())];
      if (made.block != block) return active(made);
    }
    return {block, static_cast<std::uint32_t>(node), d.hierarchy.vertices.position_of(node)};
  }
  // At a level, inner splits of the block's are done as it says, whoever made the vertices.
  Active corner_of(const Place& finest, std::size_t k) const {
    const KeptEnd& end = data(finest.block).end;
    const std::uint32_t v = end.triangle(finest.triangle)[k];
    const OneCut* const cut = cut_of(finest.block);
    if (cut == nullptr || cut->list == nullptr) return active(end.name(v));
    const BlockHierarchy::Data& d = cut->data();
    return of_node(finest.block, d, active_above(*cut, d.leaf_of_vertex[v]));
  }

  static bool is_split(const OneCut& cut, std::uint32_t root) {
    const SplitId s = cut.data().hierarchy.vertices.split_of(cut.data().node_of_root[root]);
    return s != kNoSplit && cut.is_done(s);
  }
  bool has_split_root(const Place& at) const {
    const OneCut* const cut = cut_of(at.block);
    if (cut == nullptr || cut->list != nullptr) return true;
    for (const std::uint32_t root : cut->data().roots_of_triangle[at.triangle]) {
      if (is_split(*cut, root)) return true;
    }
    return false;
  }

  void add(const Place& finest) {
    const KeptEnd& end = data(finest.block).end;
    std::array<Active, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = corner_of(finest, k);
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    Place at = finest;
    while (!has_split_root(at) && at.triangle < sources_[at.block].size()) {
      at = sources_[at.block][at.triangle];
    }
    Triangle& triangle = result_.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      triangle[k] = VertexId{static_cast<std::uint32_t>(result_.positions.size())};
      result_.positions.push_back(mesh_.schema->facts.grid.position(corners[k].position));
    }
    const std::uint32_t category = end.category(finest.triangle);
    const std::uint32_t materials = mesh_.schema->coding.material_count;
    if (!result_.materials.empty()) {
      result_.material_of_triangle.push_back(MaterialId{category % materials});
    }
    if (!result_.parts.empty()) result_.part_of_triangle.push_back(PartId{category / materials});
    for (std::size_t l = 0; l < result_.layers.size(); ++l) {
      for (std::size_t k = 0; k < 3; ++k) add_value(at, corners, l, k);
    }
  }

  void add_value(const Place& at, const std::array<Active, 3>& corners, std::size_t l,
                 std::size_t k) {
    AttributeLayer& layer = result_.layers[l];
    std::vector<float> value(layer.dimension, 0);
    const OneCut* const cut = cut_of(at.block);
    bool is_derived = false;
    if (cut == nullptr) {
      const ResidentBlock::Data& block = data(at.block);
      is_derived = block.end.is_derived(at.triangle);
      const LayerValues values(mesh_.schema->codings[l], layer.dimension);
      values.read(block.end.value(l, 3 * std::size_t(at.triangle) + k), value);
    } else {
      is_derived = read_value(*cut, at, corners[k], l, k, value);
    }
    if (is_derived && layer.role == AttributeRole::Normal) {
      const Vec3f n =
          geometric_normal(corners[0].position, corners[1].position, corners[2].position);
      if (n != Vec3f{}) value = {n.x, n.y, n.z};
    }
    layer.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(layer.value_count())});
    layer.values.insert(layer.values.end(), value.begin(), value.end());
  }

  // True if the triangle shows its geometric normal.
  bool read_value(const OneCut& cut, const Place& at, const Active& corner, std::size_t l,
                  std::size_t k, std::vector<float>& value) {
    const MeshHierarchy& h = cut.data().hierarchy;
    std::vector<std::uint32_t>& new_of = new_of_triangle_[at.block];
    if (new_of.empty()) {
      new_of.resize(cut.data().triangle_of.size());
      for (std::uint32_t i = 0; i < new_of.size(); ++i) new_of[cut.data().triangle_of[i]] = i;
    }
    const std::uint32_t t = new_of[at.triangle];
    const WedgeId wedge = h.vertices.triangles[t][k];
    const std::uint32_t v = cut.block().data().end.triangle(at.triangle)[k];
    NodeId node = cut.data().leaf_of_vertex[v];
    const NodeId active = active_above(cut, node);
    // The corner stands where the block says: what finer blocks split, coarser ones have active.
    CHECK(h.vertices.position_of(active) == corner.position);
    RelativeAttribute a = h.at_leaf(l, node, wedge);
    for (; node != active; node = h.vertices.parent(node)) {
      a = h.above(l, h.vertices.split_above(node), h.vertices.is_second(node), a, wedge);
    }
    const StoredValue found = h.value(l, active, a);
    value.assign(found.begin(), found.end());
    const SplitId deriving = h.vertices.deriving_split(TriangleId{t});
    return deriving != kNoSplit && !cut.is_done(deriving);
  }

  const BlockMesh::Impl& mesh_;
  std::map<std::uint32_t, std::vector<Place>> sources_;
  std::map<std::uint32_t, OneCut> cuts_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> new_of_triangle_;  // per block by vertex
  Mesh result_;
};

}  // namespace

void check_by_vertex(const BlockMesh& mesh) {
  const Mesh expected = BlocksOracle(mesh.impl()).run();
  const Mesh shown = mesh.extract();
  REQUIRE(check_mesh(shown).ok());
  CHECK((described(shown) == described(expected)));
  CHECK(mesh.triangle_count() == shown.triangle_count());
  TriangleBag drawn;
  for (const ShownRange& range : mesh.shown()) {
    add_drawn(range.block->draw_list(), {range.sn, range.fn, range.nsn}, drawn);
  }
  for (const ShownCut& cut : mesh.shown_cuts()) {
    const auto all = [](const DrawPart& part) {
      return Range{0, static_cast<std::uint32_t>(part.triangle_count())};
    };
    add_drawn(cut.list, {all(cut.list.sn), all(cut.list.fn), all(cut.list.nsn)}, drawn);
  }
  const Grid& grid = mesh.facts().grid;
  const auto place = [&grid](const Vec3d& p) { return draw_position(grid, grid.nearest(p)); };
  CHECK((drawn == drawn_of_mesh(shown, place)));
}

// How wrong the vertices of all resident blocks are, from fine to coarse, as the finer ones tell:
// also those that the cut does not go through any more.
std::size_t check_levels_are_right(const BlockMesh& mesh, const ViewParameters& view) {
  const BlockMesh::Impl& impl = mesh.impl();
  const ViewError error(view, mesh.facts().grid);
  std::map<std::pair<std::uint32_t, std::uint32_t>, RoundedError> error_of_name;
  std::size_t between = 0, wrong = 0;
  for (std::uint32_t block = static_cast<std::uint32_t>(impl.resident.size()); block-- > 0;) {
    if (impl.resident[block] == nullptr || impl.graph.is_base(block)) continue;
    std::vector<ResidentBlockPtr> needed;
    for (const std::uint32_t n : impl.graph.dependencies(block)) {
      needed.push_back(impl.resident[n]);
    }
    const BlockHierarchyPtr hierarchy = make_tall_hierarchy(*impl.resident[block], needed);
    const BlockHierarchy::Data& data = hierarchy->data();
    BlockErrors errors(data);
    const ResidentBlock::Data& resident = impl.resident[block]->data();
    for (std::uint32_t v = 0; v < resident.end.vertex_count(); ++v) {
      const codec::VertexName name = resident.end.name(v);
      const auto known = error_of_name.find({name.block, name.vertex});
      if (known != error_of_name.end()) errors.tighten(v, known->second);
    }
    errors.settle();
    for (std::uint32_t r = 0; r < data.node_of_root.size(); ++r) {
      const codec::VertexName name = resident.root_names[r];
      error_of_name[{name.block, name.vertex}] = errors.of_root(r);
    }
    const bool is_in_cut = std::ranges::binary_search(impl.cut, block);
    const int level = impl.levels.shown(block);
    if (!is_in_cut || level == kFullLevel) continue;
    const LevelList* const list = impl.levels.list(block);
    between += list != nullptr;
    const VertexHierarchy& h = data.hierarchy.vertices;
    for (std::size_t s = 0; s < h.split_count(); ++s) {
      if (list != nullptr ? (list->done[s / 64] >> (s % 64) & 1) != 0
                          : data.is_inner_split(SplitId{static_cast<std::uint32_t>(s)})) {
        continue;
      }
      const Vec3f position = error.position(h.position_of(h.node_of_split[s]));
      // It is inside its own sphere, and inside the block's.
      SplitBounds in_block = impl.graph.own(block).bounds;
      set_error(in_block, error_of(errors.bounds()[s]));
      wrong += error.is_wrong(error.watch(errors.bounds()[s], position, 1)) &&
               error.is_wrong(error.watch(in_block, impl.graph.own(block).center, 1));
    }
  }
  CHECK(wrong == 0);
  return between;
}

std::size_t check_nothing_is_wrong(const BlockMesh& mesh, const ViewParameters& view) {
  const ViewError error(view, mesh.facts().grid);
  std::size_t blocks = 0, wrong = 0;
  for (const std::uint32_t block : mesh.impl().cut) {
    const BlockCut* const cut = mesh.impl().cuts.cut(block);
    if (cut == nullptr) continue;
    ++blocks;
    const VertexHierarchy& h = cut->data().hierarchy.vertices;
    for (std::uint32_t v = 0; v < cut->data().leaf_of_vertex.size(); ++v) {
      if (cut->data().wedge_of_vertex[v] == kNone) continue;
      const NodeId node = active_above(*cut, cut->data().leaf_of_vertex[v]);
      const SplitId s = h.split_of(node);
      if (s == kNoSplit) continue;
      const Vec3f position = error.position(h.position_of(node));
      wrong += error.is_wrong(error.watch(cut->bounds()[index_of(s)], position, 1));
    }
  }
  CHECK(wrong == 0);
  return blocks;
}

}  // namespace crease
