#include "runtime/block_hierarchy.h"

#include "codec/model_of_blocks.h"
#include "codec/unfold_blocks.h"
#include "crease/build_hierarchy.h"
#include "crease/decode_model.h"
#include "hierarchy/hierarchy_walk.h"
#include "runtime/inner_splits.h"
#include "runtime/resident_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace crease {

namespace {

void one_by_one(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

struct ModelOfOne {
  DecodedModel model;
  std::vector<LevelError> own_errors;  // per contraction
  LevelError coarser;                  // as of BlockHierarchy::Data
};

enum class Height { Block, WithInner };

// The finest mesh of the block alone, and the contractions that lead to its coarse end, then those
// that undo its inner splits.
ModelOfOne model_of(const ResidentBlock::Data& block, std::span<const ResidentBlockPtr> needed,
                    Height height) {
  const BlockFacts& facts = block.entry.facts;
  const codec::CoarseEnd start = coarse_end_of(needed, facts);
  codec::BlockUnfolder unfolder;
  ModelOfOne result;
  if (height == Height::WithInner) {
    codec::UnfoldedBlock inner = inner_splits_of(facts, needed, start);
    result.coarser = inner.coarse;
    if (!inner.splits.empty()) unfolder.add_part(std::move(inner));
  }
  unfolder.add_alone(facts, block.end.unpacked().mesh, block.splits.unpacked(), start);
  codec::ModelOfBlocks blocks(*block.schema, unfolder);
  blocks.fill(result.model, unfolder.blocks().size(), one_by_one);
  result.own_errors.assign(blocks.own_errors().begin(), blocks.own_errors().end());
  return result;
}

// The first child of a split keeps its parent's number, so a root is the first vertex of its tree.
std::vector<std::uint32_t> roots_of_vertices(const ResidentBlock::Data& block) {
  std::vector<std::uint32_t> root(block.end.vertex_count());
  const std::size_t roots = root.size() - block.splits.size();
  for (std::uint32_t v = 0; v < root.size(); ++v) {
    root[v] = v < roots ? v : root[block.splits.vertex(v - roots)];
  }
  return root;
}

void find_nodes(const ResidentBlock::Data& block, const HierarchyMaps& maps,
                BlockHierarchy::Data& data) {
  const VertexHierarchy& h = data.hierarchy.vertices;
  const std::vector<WedgeRange> wedges = wedge_ranges(h);
  const std::vector<std::uint32_t> root_of_vertex = roots_of_vertices(block);
  data.leaf_of_vertex = maps.leaf_of_vertex;
  data.node_of_root.reserve(block.root_names.size());
  data.wedge_of_vertex.reserve(data.leaf_of_vertex.size());
  for (std::uint32_t v = 0; v < data.leaf_of_vertex.size(); ++v) {
    const WedgeRange range = wedges[index_of(data.leaf_of_vertex[v])];
    data.wedge_of_vertex.push_back(range.begin < range.end ? range.begin : kNone);
    if (v >= block.root_names.size()) continue;
    NodeId root = data.leaf_of_vertex[v];
    while (!h.is_root(root) && !data.is_inner_split(h.split_above(root))) root = h.parent(root);
    data.node_of_root.push_back(root);
  }
  data.id_of_triangle = maps.new_of_triangle;
  data.triangle_of.resize(maps.new_of_triangle.size());
  data.roots_of_triangle.reserve(maps.new_of_triangle.size());
  for (std::uint32_t t = 0; t < maps.new_of_triangle.size(); ++t) {
    data.triangle_of[index_of(maps.new_of_triangle[t])] = t;
    codec::Corners roots = block.end.triangle(t);
    for (std::uint32_t& v : roots) v = root_of_vertex[v];
    data.roots_of_triangle.push_back(roots);
  }
  data.coarse_triangles = block.coarse_triangles;
  const TriangleRange of_roots = h.coarse_triangles();
  data.shows_roots = of_roots.size() > data.coarse_triangles;
}

// Pairs of a root and what belongs to it, as lists.
void sort_by_root(std::vector<std::array<std::uint32_t, 2>> pairs, std::size_t roots,
                  std::size_t limit, std::vector<std::uint32_t>& first, PackedIndices<>& lists) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  first.assign(roots + 1, 0);
  lists = PackedIndices<>(bits_for(limit));
  for (const auto& [root, what] : pairs) {
    ++first[root + 1];
    lists.push_back(what);
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
}

void find_rings(BlockHierarchy::Data& data) {
  const std::size_t roots = data.node_of_root.size();
  std::vector<std::array<std::uint32_t, 2>> triangles, rings;
  for (std::uint32_t t = 0; t < data.roots_of_triangle.size(); ++t) {
    for (const std::uint32_t r : data.roots_of_triangle[t]) {
      if (t < data.coarse_triangles) triangles.push_back({r, t});
      for (const std::uint32_t other : data.roots_of_triangle[t]) rings.push_back({r, other});
    }
  }
  sort_by_root(std::move(triangles), roots, data.coarse_triangles, data.first_triangle_of_root,
               data.triangles_of_root);
  sort_by_root(std::move(rings), roots, roots, data.first_in_ring, data.rings);
}

void find_root_splits(BlockHierarchy::Data& data) {
  const VertexHierarchy& h = data.hierarchy.vertices;
  std::vector<std::uint32_t> root_of_node(h.root_count);
  for (std::uint32_t r = 0; r < data.node_of_root.size(); ++r) {
    root_of_node[index_of(data.node_of_root[r])] = r;
  }
  for (std::uint32_t n = 0; n < h.root_count; ++n) {
    if (h.split_of(NodeId{n}) != kNoSplit) data.root_of_split.push_back(root_of_node[n]);
  }
}

void count_requirable_splits(BlockHierarchy::Data& data) {
  const VertexHierarchy& h = data.hierarchy.vertices;
  std::vector<char> is_above(h.split_count(), 0);
  for (std::uint32_t v = 0; v < data.leaf_of_vertex.size(); ++v) {
    if (data.wedge_of_vertex[v] == kNone) continue;
    for (NodeId n = data.leaf_of_vertex[v]; !h.is_root(n); n = h.parent(n)) {
      char& above = is_above[index_of(h.split_above(n))];
      if (above) break;
      above = 1;
      ++data.requirable_splits;
    }
  }
}

void sort_triangles_by_patch(const ResidentBlock::Data& block, BlockHierarchy::Data& data) {
  std::vector<std::uint32_t> labels;
  for (std::size_t t = 0; t < block.end.triangle_count(); ++t) labels.push_back(block.end.label(t));
  data.triangles_by_patch.resize(labels.size());
  std::iota(data.triangles_by_patch.begin(), data.triangles_by_patch.end(), 0);
  std::stable_sort(data.triangles_by_patch.begin(), data.triangles_by_patch.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return labels[a] < labels[b]; });
}

void find_inner(const ResidentBlock::Data& block, const ModelOfOne& of_one,
                const HierarchyMaps& maps, BlockHierarchy::Data& data) {
  data.coarser = of_one.coarser;
  const std::size_t own = block.splits.size(), all = maps.split_of_contraction.size();
  if (own == all) return;
  data.is_inner.assign(all, 0);
  for (std::size_t i = own; i < all; ++i) data.is_inner[index_of(maps.split_of_contraction[i])] = 1;
}

void find_own_errors(const ModelOfOne& of_one, const HierarchyMaps& maps,
                     BlockHierarchy::Data& data) {
  data.own_errors.resize(data.hierarchy.vertices.split_count());
  for (std::size_t i = 0; i < of_one.own_errors.size(); ++i) {
    data.own_errors[index_of(maps.split_of_contraction[i])] =
        RoundedError::from(of_one.own_errors[i]);
  }
}

// What a file may say and no hierarchy may have.
bool is_sound(const DecodedModel& model) {
  if (!check_mesh(model.mesh).ok()) return false;
  return std::all_of(model.sequence.new_values.begin(), model.sequence.new_values.end(),
                     [](const std::vector<float>& values) {
                       return std::all_of(values.begin(), values.end(),
                                          [](float value) { return std::isfinite(value); });
                     });
}

std::size_t bytes_of(const BlockHierarchy::Data& data) {
  return sizeof(data) + hierarchy_bytes(data.hierarchy).total() +
         4 * (data.leaf_of_vertex.size() + data.wedge_of_vertex.size() + data.node_of_root.size() +
              data.root_of_split.size() + data.id_of_triangle.size() + data.triangle_of.size() +
              data.first_triangle_of_root.size() + data.first_in_ring.size() +
              data.triangles_by_patch.size()) +
         data.triangles_of_root.bytes() + sizeof(codec::Corners) * data.roots_of_triangle.size() +
         sizeof(RoundedError) * data.own_errors.size();
}

}  // namespace

BlockHierarchy::BlockHierarchy(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
BlockHierarchy::~BlockHierarchy() = default;

BlockId BlockHierarchy::id() const {
  return data_->id;
}

std::size_t BlockHierarchy::bytes() const {
  return data_->bytes;
}

BlockHierarchyJob::BlockHierarchyJob(ResidentBlockPtr block, std::vector<ResidentBlockPtr> needed)
    : block_(std::move(block)), needed_(std::move(needed)) {}

namespace {

BlockHierarchyPtr make_hierarchy(const ResidentBlock& of, std::span<const ResidentBlockPtr> needed,
                                 Height height) {
  const ResidentBlock::Data& block = of.data();
  auto data = std::make_unique<BlockHierarchy::Data>();
  data->id = of.id();
  data->coarse = block.entry.facts.coarse;
  data->fine = block.entry.facts.fine;
  const ModelOfOne of_one = model_of(block, needed, height);
  const DecodedModel& model = of_one.model;
  HierarchyMaps maps;
  data->is_empty = true;
  if (is_sound(model)) {
    Result<MeshHierarchy> hierarchy = build_hierarchy(model.mesh, model.sequence, {}, &maps);
    data->is_empty = !hierarchy.ok();
    if (hierarchy.ok()) data->hierarchy = *std::move(hierarchy);
  }
  if (!data->is_empty) {
    find_inner(block, of_one, maps, *data);
    find_nodes(block, maps, *data);
    find_own_errors(of_one, maps, *data);
  }
  if (!data->is_empty && height == Height::Block) {
    find_rings(*data);
    find_root_splits(*data);
    count_requirable_splits(*data);
    sort_triangles_by_patch(block, *data);
  }
  data->bytes = bytes_of(*data);
  return std::make_shared<const BlockHierarchy>(std::move(data));
}

}  // namespace

BlockHierarchyPtr BlockHierarchyJob::run() const {
  return make_hierarchy(*block_, needed_, Height::Block);
}

BlockHierarchyPtr make_tall_hierarchy(const ResidentBlock& block,
                                      std::span<const ResidentBlockPtr> needed) {
  return make_hierarchy(block, needed, Height::WithInner);
}

}  // namespace crease
