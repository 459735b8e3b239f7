#include "codec/model_of_blocks.h"

#include "hierarchy/geometric_normal.h"

#include <algorithm>
#include <utility>

namespace crease::codec {

namespace {

LevelError largest(const LevelError& a, const LevelError& b) {
  return {std::max(a.surface, b.surface), std::max(a.line, b.line), std::max(a.degrees, b.degrees),
          std::max(a.texture, b.texture)};
}

// Between those at the two ends of a block.
LevelError between(const LevelError& fine, const LevelError& coarse, float share) {
  const auto mix = [share](float a, float b) { return a + (b - a) * share; };
  return {mix(fine.surface, coarse.surface), mix(fine.line, coarse.line),
          mix(fine.degrees, coarse.degrees), mix(fine.texture, coarse.texture)};
}

}  // namespace

ModelOfBlocks::ModelOfBlocks(const ModelFacts& facts, std::span<const LayerCoding> codings,
                             const BlockCoding& coding, const BlockUnfolder& unfolder)
    : facts_(facts),
      coding_(coding),
      blocks_(unfolder.blocks()),
      slot_count_(unfolder.slot_count()),
      triangle_count_(unfolder.triangle_count()) {
  values_.reserve(facts.layers.size());  // pools point into it
  for (std::size_t l = 0; l < facts.layers.size(); ++l) {
    values_.emplace_back(codings[l], facts.layers[l].dimension);
    pools_.emplace_back(values_[l], facts.layers[l].dimension);
  }
}

void ModelOfBlocks::fill(DecodedModel& model, std::size_t contracted_bands,
                         const ForEach& for_each) {
  fill_mesh(model.mesh);
  for (const LevelError& error : error_of_slot_) model.error = largest(model.error, error);
  fill_sequence(model.sequence, contracted_bands, for_each);
  for (std::size_t l = 0; l < pools_.size(); ++l) {
    const std::vector<float>& all = pools_[l].numbers();
    const std::vector<float>& own = model.mesh.layers[l].values;
    model.sequence.new_values.emplace_back(all.begin() + std::ptrdiff_t(own.size()), all.end());
  }
}

// Every triangle as the finest block has it.
void ModelOfBlocks::fill_mesh(Mesh& mesh) {
  std::vector<Place> places(triangle_count_);
  positions_.resize(slot_count_);
  error_of_slot_.resize(slot_count_);
  for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
    for (std::uint32_t t = 0; t < blocks_[b].triangles.size(); ++t) {
      places[blocks_[b].triangles[t]] = {b, t};
    }
    for (std::size_t v = 0; v < blocks_[b].vertices.size(); ++v) {
      positions_[blocks_[b].vertices[v]] = blocks_[b].end.positions[v];
      error_of_slot_[blocks_[b].vertices[v]] = blocks_[b].fine;
    }
  }
  for (const Vec3i& p : positions_) mesh.positions.push_back(facts_.grid.position(p));
  mesh.triangles.reserve(triangle_count_);
  for (const Place& place : places) {
    const UnfoldedBlock& block = blocks_[place.block];
    const Corners& corners = block.end.triangles[place.triangle];
    mesh.triangles.push_back({VertexId{block.vertices[corners[0]]},
                              VertexId{block.vertices[corners[1]]},
                              VertexId{block.vertices[corners[2]]}});
    const std::uint32_t category = block.end.category[place.triangle];
    if (!mesh.materials.empty()) {
      mesh.material_of_triangle.push_back(MaterialId{category % coding_.material_count});
    }
    if (!mesh.parts.empty()) {
      mesh.part_of_triangle.push_back(PartId{category / coding_.material_count});
    }
  }
  of_corner_.resize(pools_.size());
  mesh.layers.resize(pools_.size());
  const CornersAround around(mesh);
  for (std::size_t l = 0; l < pools_.size(); ++l)
    fill_layer(places, l, mesh, around, mesh.layers[l]);
}

void ModelOfBlocks::fill_layer(std::span<const Place> places, std::size_t l, const Mesh& mesh,
                               const CornersAround& around, AttributeLayer& layer) {
  const LayerSchema& schema = facts_.layers[l];
  layer.name = schema.name;
  layer.role = schema.role;
  layer.interpolation = schema.interpolation;
  layer.dimension = schema.dimension;
  ValuePool& pool = pools_[l];
  const auto values_of = [&](std::size_t t) {
    return &blocks_[places[t].block].end.values[l][3 * std::size_t(places[t].triangle)];
  };
  // Of a model that is cut off here, a triangle may show its geometric normal already.
  const auto is_derived = [&](std::size_t t) {
    return schema.role == AttributeRole::Normal &&
           blocks_[places[t].block].end.derived[places[t].triangle] != 0;
  };
  const auto value_of = [&](std::uint32_t corner) { return values_of(corner / 3)[corner % 3]; };
  const auto vertex_of = [&](std::uint32_t corner) {
    return static_cast<std::uint32_t>(index_of(mesh.triangles[corner / 3][corner % 3]));
  };
  std::vector<char> is_flat(3 * std::size_t(triangle_count_), 0);  // per corner
  for (std::size_t t = 0; t < triangle_count_; ++t) {
    const CodedValue* values = values_of(t);
    if (is_derived(t) || values[0] != values[1] || values[1] != values[2]) continue;
    std::fill_n(is_flat.begin() + 3 * std::ptrdiff_t(t), 3, 1);
  }
  for (std::uint32_t v = 0; v < slot_count_; ++v) {
    const std::span<const std::uint32_t> corners = around.of(v);
    for (const std::uint32_t corner : corners) {
      if (is_flat[corner] != 1) continue;
      for (const std::uint32_t other : corners) {
        // 2: as flat as that one, and no need to look around it again.
        if (!is_derived(other / 3) && value_of(other) == value_of(corner)) is_flat[other] = 2;
      }
    }
  }
  std::vector<std::uint32_t>& of_corner = of_corner_[l];
  of_corner.reserve(is_flat.size());
  for (std::uint32_t corner = 0; corner < is_flat.size(); ++corner) {
    of_corner.push_back(is_derived(corner / 3)
                            ? geometric_value(mesh.triangles[corner / 3], pool)
                            : pool.intern(value_of(corner),
                                          is_flat[corner] ? ValuePool::kFlat : vertex_of(corner)));
  }
  layer.values = pool.numbers();
  for (const std::uint32_t id : of_corner) layer.of_corner.push_back(AttributeId{id});
}

std::uint32_t ModelOfBlocks::geometric_value(const Triangle& triangle, ValuePool& pool) const {
  const Vec3f n =
      geometric_normal(positions_[index_of(triangle[0])], positions_[index_of(triangle[1])],
                       positions_[index_of(triangle[2])]);
  return pool.intern_direction(n == Vec3f{} ? Vec3f{0, 0, 1} : n);  // without area: any
}

void ModelOfBlocks::fill_sequence(ContractionSequence& sequence, std::size_t contracted_bands,
                                  const ForEach& for_each) {
  sequence.placement = Placement::Endpoint;
  if (contracted_bands == 0) return;
  AttributeRejoiner rejoiner(facts_.layers, pools_, std::move(of_corner_));
  for (std::size_t end = blocks_.size(), begin = end; end > 0; end = begin) {
    while (begin > 0 && blocks_[begin - 1].band == blocks_[end - 1].band) --begin;
    contract_band(blocks_.subspan(begin, end - begin), rejoiner, for_each, sequence);
    if (--contracted_bands == 0) return;
  }
}

struct ModelOfBlocks::Pending {
  std::uint32_t block = 0;
  OrderedContraction contraction;
  CornerChanges* changes = nullptr;
};

// The blocks of a band touch no vertex of each other's, so their contractions mix by cost.
void ModelOfBlocks::contract_band(std::span<const UnfoldedBlock> blocks,
                                  AttributeRejoiner& rejoiner, const ForEach& for_each,
                                  ContractionSequence& sequence) {
  std::vector<ContractionOrder> orders(blocks.size());
  for_each(blocks.size(), [&](std::size_t b) {
    orders[b] = order_contractions(blocks[b], coding_, facts_.layers, values_);
  });
  std::vector<std::vector<CornerChanges>> changes(blocks.size());
  std::vector<Pending> all;
  for (std::uint32_t b = 0; b < blocks.size(); ++b) {
    ContractionOrder& order = orders[b];
    changes[b] = rejoiner.rejoin(blocks[b], order.contractions, std::move(order.wedges));
    changes[b].resize(order.contractions.size());
    for (std::size_t i = 0; i < order.contractions.size(); ++i) {
      all.push_back({b, order.contractions[i], &changes[b][i]});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Pending& a, const Pending& b) {
    return a.contraction.cost < b.contraction.cost;
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    const float share = static_cast<float>(i + 1) / static_cast<float>(all.size());
    append(blocks[all[i].block], all[i].contraction, *all[i].changes, share, sequence);
  }
}

void ModelOfBlocks::append(const UnfoldedBlock& block, const OrderedContraction& contraction,
                           CornerChanges& changes, float share, ContractionSequence& sequence) {
  const Split& split = block.splits[contraction.split];
  Contraction c;
  c.kept = VertexId{block.vertices[split.vertex]};
  c.removed = VertexId{block.vertices[block.second_child(contraction.split)]};
  c.position = split.parent_position;
  LevelError& error = error_of_slot_[index_of(c.kept)];
  error = largest(largest(error, error_of_slot_[index_of(c.removed)]),
                  between(block.fine, block.coarse, share));
  c.error = error;
  Vec3i& kept = positions_[index_of(c.kept)];
  if (c.position != kept && c.position != positions_[index_of(c.removed)]) {
    sequence.placement = Placement::Optimal;
  }
  kept = c.position;
  c.first_change = static_cast<std::uint32_t>(sequence.changes.size());
  c.change_count = static_cast<std::uint32_t>(changes.changes.size());
  sequence.changes.insert(sequence.changes.end(), changes.changes.begin(), changes.changes.end());
  c.first_derived = static_cast<std::uint32_t>(sequence.derived.size());
  c.derived_count = static_cast<std::uint32_t>(changes.derived.size());
  sequence.derived.insert(sequence.derived.end(), changes.derived.begin(), changes.derived.end());
  sequence.contractions.push_back(c);
}

}  // namespace crease::codec
