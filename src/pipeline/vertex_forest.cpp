#include "pipeline/vertex_forest.h"

#include "hierarchy/grid_sum.h"

#include <limits>

namespace crease {

VertexForest make_forest(std::size_t vertex_count, const std::vector<Contraction>& contractions) {
  VertexForest forest;
  forest.leaf_count = static_cast<std::uint32_t>(vertex_count);
  std::vector<std::uint32_t> birth_of_slot(vertex_count);
  for (std::uint32_t v = 0; v < vertex_count; ++v) birth_of_slot[v] = v;
  std::vector<bool> has_parent(vertex_count + contractions.size(), false);
  for (const Contraction& c : contractions) {
    const std::array<std::uint32_t, 2> children = {birth_of_slot[index_of(c.kept)],
                                                   birth_of_slot[index_of(c.removed)]};
    for (std::uint32_t child : children) has_parent[child] = true;
    birth_of_slot[index_of(c.kept)] =
        static_cast<std::uint32_t>(vertex_count + forest.children.size());
    forest.children.push_back(children);
  }

  for (std::uint32_t birth = 0; birth < has_parent.size(); ++birth) {
    if (!has_parent[birth]) forest.birth_of_node.push_back(birth);
  }
  forest.root_count = static_cast<std::uint32_t>(forest.birth_of_node.size());
  forest.birth_of_node.reserve(has_parent.size());
  forest.split_of_contraction.resize(contractions.size());
  for (std::uint32_t node = 0; node < forest.birth_of_node.size();
       ++node) {  // grows: breadth first
    const std::uint32_t birth = forest.birth_of_node[node];
    if (forest.is_leaf(birth)) continue;
    const std::uint32_t contraction = birth - forest.leaf_count;
    forest.split_of_contraction[contraction] =
        SplitId{static_cast<std::uint32_t>(forest.contraction_of_split.size())};
    forest.contraction_of_split.push_back(contraction);
    for (std::uint32_t child : forest.children[contraction]) forest.birth_of_node.push_back(child);
  }
  forest.node_of_birth.resize(has_parent.size());
  for (std::uint32_t node = 0; node < forest.birth_of_node.size(); ++node) {
    forest.node_of_birth[forest.birth_of_node[node]] = NodeId{node};
  }
  return forest;
}

namespace {

bool fits_16_bits(const Vec3i& d) {
  constexpr int kLow = std::numeric_limits<std::int16_t>::min();
  constexpr int kHigh = std::numeric_limits<std::int16_t>::max();
  for (int i = 0; i < 3; ++i) {
    if (d[i] < kLow || d[i] > kHigh) return false;
  }
  return true;
}

}  // namespace

VertexHierarchy number_nodes(const VertexForest& forest, const std::vector<Vec3i>& leaf_positions,
                             const ContractionSequence& sequence) {
  const auto position = [&](std::uint32_t birth) {
    return forest.is_leaf(birth) ? leaf_positions[birth]
                                 : sequence.contractions[birth - forest.leaf_count].position;
  };
  VertexHierarchy h;
  h.grid = sequence.grid;
  h.root_count = forest.root_count;
  h.node_of_split.reserve(forest.contraction_count());
  h.bounds.resize(forest.contraction_count());
  for (std::uint32_t node = 0; node < forest.birth_of_node.size(); ++node) {
    const std::uint32_t birth = forest.birth_of_node[node];
    h.is_split.push_back(!forest.is_leaf(birth));
    if (!forest.is_leaf(birth)) h.node_of_split.push_back(NodeId{node});
    if (h.is_root(NodeId{node})) {
      h.root_positions.push_back(position(birth));
      continue;
    }
    const std::uint32_t parent = forest.birth_of_node[index_of(h.parent(NodeId{node}))];
    const Vec3i delta = grid_difference(position(birth), position(parent));
    const bool wide = !fits_16_bits(delta);
    h.is_wide.push_back(wide);
    if (wide) h.wide_deltas.push_back(delta);
    const auto narrow = [&](std::int32_t d) { return static_cast<std::int16_t>(wide ? 0 : d); };
    h.deltas.push_back({narrow(delta.x), narrow(delta.y), narrow(delta.z)});
  }
  for (std::size_t s = 0; s < h.split_count(); ++s) {
    const LevelError& error = sequence.contractions[forest.contraction_of_split[s]].error;
    h.bounds[s].surface = RoundedUp::from(error.surface);
    h.bounds[s].line = RoundedUp::from(error.line);
    h.bounds[s].degrees = RoundedUp::from(error.degrees);
    h.bounds[s].texture = RoundedUp::from(error.texture);
  }
  return h;
}

std::vector<std::uint32_t> number_wedges(const VertexForest& forest,
                                         const std::vector<std::uint32_t>& wedge_count_of_leaf,
                                         VertexHierarchy& hierarchy) {
  // How many are under each birth, then where each one's begin, from the roots down.
  std::vector<std::uint32_t> count = wedge_count_of_leaf;
  for (const auto& [t, u] : forest.children) count.push_back(count[t] + count[u]);
  std::vector<std::uint32_t> first(count.size());
  std::uint32_t total = 0;
  for (std::uint32_t root = 0; root < forest.root_count; ++root) {
    hierarchy.root_wedges.push_back(WedgeId{total});
    first[forest.birth_of_node[root]] = total;
    total += count[forest.birth_of_node[root]];
  }
  hierarchy.root_wedges.push_back(WedgeId{total});
  hierarchy.second_wedge.resize(forest.contraction_count());
  for (std::size_t i = forest.contraction_count(); i-- > 0;) {
    const auto& [t, u] = forest.children[i];
    first[t] = first[forest.leaf_count + i];
    first[u] = first[t] + count[t];
    hierarchy.second_wedge[index_of(forest.split_of_contraction[i])] = WedgeId{first[u]};
  }
  first.resize(forest.leaf_count);
  return first;
}

}  // namespace crease
