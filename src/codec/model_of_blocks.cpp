#include "codec/model_of_blocks.h"

#include <algorithm>
#include <utility>

namespace crease::codec {

ModelOfBlocks::ModelOfBlocks(const ModelSchema& schema, const BlockUnfolder& unfolder)
    : schema_(schema),
      blocks_(unfolder.blocks()),
      slot_count_(unfolder.slot_count()),
      triangle_count_(unfolder.triangle_count()),
      layers_(schema) {}

void ModelOfBlocks::fill(DecodedModel& model, std::size_t contracted_bands,
                         const ForEach& for_each) {
  fill_mesh(model.mesh);
  model.sequence.grid = schema_.facts.grid;
  fill_sequence(model.mesh, contracted_bands, for_each, model.sequence);
  for (std::size_t l = 0; l < layers_.pools().size(); ++l) {
    const std::vector<float>& all = layers_.pools()[l].numbers();
    const std::vector<float>& own = model.mesh.layers[l].values;
    model.sequence.new_values.emplace_back(all.begin() + std::ptrdiff_t(own.size()), all.end());
  }
}

// Every triangle as the finest block has it.
void ModelOfBlocks::fill_mesh(Mesh& mesh) {
  std::vector<EndPiece> pieces;
  std::vector<PlacedTriangle> triangles(triangle_count_);
  positions_.resize(slot_count_);
  error_of_slot_.resize(slot_count_);
  for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
    const UnfoldedBlock& block = blocks_[b];
    pieces.push_back({&block.end, block.vertices});
    for (std::uint32_t t = 0; t < block.triangles.size(); ++t) {
      triangles[block.triangles[t]] = {b, t};
    }
    for (std::size_t v = 0; v < block.vertices.size(); ++v) {
      positions_[block.vertices[v]] = block.end.positions[v];
      error_of_slot_[block.vertices[v]] = block.fine;
    }
  }
  mesh = join_ends(schema_, pieces, triangles, positions_, layers_.pools());
}

// Where the finest block's fine end is not the input, that may be as far away as the block says.
void ModelOfBlocks::find_witnesses(const Mesh& mesh) {
  witnesses_ = witnesses_of(mesh, positions_);
  const double step = schema_.facts.grid.step;
  std::vector<float> from_of_triangle(triangle_count_, 0);
  bool any = false;
  for (const UnfoldedBlock& block : blocks_) {  // finest last
    any = any || block.fine.surface > 0;
    const auto from = static_cast<float>(double(block.fine.surface) / step);
    for (const std::uint32_t t : block.triangles) from_of_triangle[t] = from;
  }
  if (!any) return;
  for (std::uint32_t t = 0; t < triangle_count_; ++t) {
    for (std::uint32_t w = witnesses_.first[t]; w != kNone; w = witnesses_.all[w].next) {
      witnesses_.all[w].from = witnesses_.all[w].told = from_of_triangle[t];
    }
  }
}

void ModelOfBlocks::fill_sequence(const Mesh& mesh, std::size_t contracted_bands,
                                  const ForEach& for_each, ContractionSequence& sequence) {
  sequence.placement = Placement::Endpoint;
  if (contracted_bands == 0) return;
  find_witnesses(mesh);
  std::vector<std::vector<std::uint32_t>> of_corner(mesh.layers.size());
  for (std::size_t l = 0; l < of_corner.size(); ++l) {
    of_corner[l].reserve(mesh.layers[l].of_corner.size());
    for (const AttributeId id : mesh.layers[l].of_corner) {
      of_corner[l].push_back(static_cast<std::uint32_t>(index_of(id)));
    }
  }
  std::size_t count = 0;
  for (const UnfoldedBlock& block : blocks_) count += block.splits.size();
  if (!blocks_.empty() && contracted_bands > blocks_[0].band) sequence.contractions.reserve(count);
  AttributeRejoiner rejoiner(schema_.facts.layers, layers_.pools(), std::move(of_corner));
  for (std::size_t end = blocks_.size(), begin = end; end > 0; end = begin) {
    while (begin > 0 && blocks_[begin - 1].band == blocks_[end - 1].band) --begin;
    contract_band(blocks_.subspan(begin, end - begin), rejoiner, for_each, sequence);
    if (--contracted_bands == 0) return;
  }
}

// A contraction of the present band: of which block, and which of its order.
struct ModelOfBlocks::Pending {
  double cost = 0;
  std::uint32_t block = 0, place = 0;
};

// The blocks of a band touch no vertex of each other's, so their contractions mix by cost.
void ModelOfBlocks::contract_band(std::span<const UnfoldedBlock> blocks,
                                  AttributeRejoiner& rejoiner, const ForEach& for_each,
                                  ContractionSequence& sequence) {
  std::vector<ContractionOrder> orders(blocks.size());
  for_each(blocks.size(), [&](std::size_t b) {
    orders[b] =
        order_contractions(blocks[b], schema_, layers_.values(), error_of_slot_, witnesses_);
  });
  std::vector<CornerChanges> changes(blocks.size());
  std::vector<Pending> all;
  for (std::uint32_t b = 0; b < blocks.size(); ++b) {
    if (orders[b].placement == Placement::Optimal) sequence.placement = Placement::Optimal;
    changes[b] = rejoiner.rejoin(blocks[b], orders[b].contractions, std::move(orders[b].wedges));
    for (std::uint32_t i = 0; i < orders[b].contractions.size(); ++i) {
      all.push_back({orders[b].contractions[i].cost, b, i});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Pending& a, const Pending& b) { return a.cost < b.cost; });
  for (const Pending& p : all) {
    append(blocks[p.block], orders[p.block].contractions[p.place],
           changes[p.block].changed(p.place), changes[p.block].now_derived(p.place), sequence);
  }
}

void ModelOfBlocks::append(const UnfoldedBlock& block, const OrderedContraction& contraction,
                           std::span<const AttributeChange> changes,
                           std::span<const TriangleId> derived, ContractionSequence& sequence) {
  const Split& split = block.splits[contraction.split];
  Contraction c;
  c.kept = VertexId{block.vertices[split.vertex]};
  c.removed = VertexId{block.vertices[block.second_child(contraction.split)]};
  c.position = split.parent_position;
  c.error = error_of_slot_[index_of(c.kept)] = contraction.error;
  own_errors_.push_back(contraction.own);
  c.first_change = static_cast<std::uint32_t>(sequence.changes.size());
  c.change_count = static_cast<std::uint32_t>(changes.size());
  sequence.changes.insert(sequence.changes.end(), changes.begin(), changes.end());
  c.first_derived = static_cast<std::uint32_t>(sequence.derived.size());
  c.derived_count = static_cast<std::uint32_t>(derived.size());
  sequence.derived.insert(sequence.derived.end(), derived.begin(), derived.end());
  sequence.contractions.push_back(c);
}

}  // namespace crease::codec
