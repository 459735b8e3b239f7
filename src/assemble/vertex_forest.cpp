#include "assemble/vertex_forest.h"

#include "hierarchy/curve_order.h"
#include "hierarchy/grid_sum.h"

#include <algorithm>
#include <array>
#include <bit>

namespace crease {

namespace {

// Parents before children and right before left; turned round.
std::vector<std::uint32_t> left_to_right(const VertexForest& forest) {
  std::vector<std::uint32_t> order,
      waiting(forest.birth_of_node.begin(), forest.birth_of_node.begin() + forest.root_count);
  while (!waiting.empty()) {
    const std::uint32_t birth = waiting.back();
    waiting.pop_back();
    if (forest.is_leaf(birth)) continue;
    order.push_back(birth - forest.leaf_count);
    for (std::uint32_t child : forest.children[order.back()]) waiting.push_back(child);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

VertexForest make_forest(const std::vector<Vec3i>& leaf_positions,
                         const std::vector<Contraction>& contractions) {
  const std::size_t vertex_count = leaf_positions.size();
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
  const auto position = [&](std::uint32_t birth) -> const Vec3i& {
    return birth < vertex_count ? leaf_positions[birth]
                                : contractions[birth - vertex_count].position;
  };
  std::stable_sort(forest.birth_of_node.begin(), forest.birth_of_node.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return is_before_on_curve(position(a), position(b));
                   });
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
  forest.from_left_to_right = left_to_right(forest);
  return forest;
}

namespace {

// Bits that a number takes beside its sign, with which it lies in -2^(b-1) .. 2^(b-1) - 1.
unsigned signed_bits(std::int32_t i) {
  return static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(i < 0 ? ~i : i))) + 1;
}

unsigned signed_bits(const Vec3i& d) {
  return std::max({signed_bits(d.x), signed_bits(d.y), signed_bits(d.z)});
}

// The width that takes the fewest bytes, with 12 for each delta that is wider.
unsigned best_bits(const std::vector<Vec3i>& deltas) {
  std::array<std::size_t, 33> count_of_bits{};
  for (const Vec3i& d : deltas) ++count_of_bits[signed_bits(d)];
  unsigned best = 32;
  std::size_t wider = 0, least = 3 * 32 * deltas.size();  // in bits
  for (unsigned bits = 31; bits >= 1; --bits) {
    wider += count_of_bits[bits + 1];
    const std::size_t size = 3 * bits * deltas.size() + 96 * wider;
    if (size < least) {
      least = size;
      best = bits;
    }
  }
  return best;
}

void store_deltas(const std::vector<Vec3i>& deltas, VertexHierarchy& h) {
  const unsigned bits = best_bits(deltas);
  h.deltas = PackedIndices<>(bits);
  for (const Vec3i& d : deltas) {
    const bool wide = signed_bits(d) > bits;
    h.is_wide.push_back(wide);
    if (wide) h.wide_deltas.push_back(d);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t narrow = static_cast<std::uint32_t>(d[i]) + (1u << (bits - 1));
      h.deltas.push_back(wide ? 0 : narrow);
    }
  }
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
  h.node_of_split = PackedIndices<NodeId>(bits_for(forest.birth_of_node.size()));
  h.bounds.resize(forest.contraction_count());
  std::vector<Vec3i> deltas;
  for (std::uint32_t node = 0; node < forest.birth_of_node.size(); ++node) {
    const std::uint32_t birth = forest.birth_of_node[node];
    h.is_split.push_back(!forest.is_leaf(birth));
    if (!forest.is_leaf(birth)) h.node_of_split.push_back(NodeId{node});
    if (h.is_root(NodeId{node})) {
      h.root_positions.push_back(position(birth));
      continue;
    }
    const std::uint32_t parent = forest.birth_of_node[index_of(h.parent(NodeId{node}))];
    deltas.push_back(grid_difference(position(birth), position(parent)));
  }
  store_deltas(deltas, h);
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
  for (std::size_t i = forest.contraction_count(); i-- > 0;) {
    const auto& [t, u] = forest.children[i];
    first[t] = first[forest.leaf_count + i];
    first[u] = first[t] + count[t];
  }
  hierarchy.second_wedge = PackedIndices<WedgeId>(bits_for(std::size_t(total) + 1));
  for (std::uint32_t i : forest.contraction_of_split) {
    hierarchy.second_wedge.push_back(WedgeId{first[forest.children[i][1]]});
  }
  first.resize(forest.leaf_count);
  return first;
}

}  // namespace crease
