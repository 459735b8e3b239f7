#include "plain_decoder/model.h"

#include <utility>

namespace plain {

namespace {

// "The order of blocks": bands from coarse to fine, patch by patch.
void check_order(const Container& container) {
  const std::size_t bands = container.head.bands.size();
  std::vector<std::uint32_t> patches(bands + 1, 0);
  std::size_t band = bands;
  for (const Entry& entry : container.entries) {
    demand(entry.band <= band, "a block behind a finer one");
    band = entry.band;
    demand(entry.patch == patches[band], "not the next patch");
    ++patches[band];
  }
  demand(patches[bands] <= 1, "two bases");
  for (std::size_t b = 0; b < bands; ++b) {
    demand(patches[b] == container.head.bands[b].patches, "not as many blocks as patches");
  }
}

// "What is not a block", as far as it takes the directory and the blocks before.
void check_block(const Model& model, const Entry& entry, const Block& block,
                 std::size_t coarse_vertices, std::uint32_t number) {
  const End& fine = block.fine;
  demand(fine.places.size() == entry.vertices && fine.triangles.size() == entry.fine_triangles &&
             block.splits.size() == entry.splits,
         "a block with other counts than it says");
  const std::int64_t limit = std::int64_t(1) << model.container.head.grid_bits;
  const auto demand_on_grid = [&](const Point& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      demand(-limit < p.along(k) && p.along(k) < limit, "a vertex outside of the grid");
    }
  };
  for (const Point& p : fine.places) demand_on_grid(p);
  for (const Split& split : block.splits) demand_on_grid(split.place);
  for (std::size_t v = coarse_vertices; v < fine.names.size(); ++v) {
    const Name& name = fine.names[v];
    if (name.block == number) continue;
    demand(name.vertex < model.blocks[name.block].fine.places.size(),
           "a vertex that no coarser block has");
  }
}

}  // namespace

BlockSchema block_schema(const Container& container,
                         const std::vector<std::vector<Lattice>>& lattices) {
  constexpr std::array<BlockLayer::Kind, 4> kKinds{
      BlockLayer::Kind::Floats, BlockLayer::Kind::Lattice, BlockLayer::Kind::Octahedral,
      BlockLayer::Kind::Sextant};
  BlockSchema schema;
  for (const Layer& layer : container.head.layers) {
    BlockLayer& of_block = schema.layers.emplace_back(
        BlockLayer{kKinds[layer.coding], layer.bits, layer.dimension, layer.role == 0});
    const std::vector<Lattice>& of_layer = lattices[schema.layers.size() - 1];
    for (std::size_t k = 0; k < of_layer.size(); ++k) of_block.grains[k] = of_layer[k].grain;
  }
  const auto at_least_1 = [](std::size_t n) { return n > 0 ? static_cast<std::uint32_t>(n) : 1; };
  schema.materials = at_least_1(container.materials.size());
  schema.parts = at_least_1(container.part_names.size());
  if (container.head.version < 10) schema.rates = kRatesBefore10;
  return schema;
}

Model decode_model(const Bytes& file) {
  Model model;
  model.container = read_container(file);
  check_order(model.container);
  model.lattices = read_lattices(model.container.head.layers, model.container.tables);
  model.schema = block_schema(model.container, model.lattices);
  const std::vector<Entry>& entries = model.container.entries;
  const std::vector<Band>& bands = model.container.head.bands;
  std::vector<End> fine_ends;  // of the band before
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    const std::size_t band = entries[begin].band;
    while (end < entries.size() && entries[end].band == band) ++end;
    std::vector<End> coarse =
        coarse_ends(fine_ends, band == bands.size() ? 1 : bands[band].patches);
    fine_ends.clear();
    for (std::size_t b = begin; b < end; ++b) {
      const Entry& entry = entries[b];
      End& start = coarse[entry.patch];
      demand(start.triangles.size() == entry.coarse_triangles,
             "a block that starts from other triangles than it says");
      const auto number = static_cast<std::uint32_t>(b);
      Block block = decode_block(read_payload(file, entry), number, model.schema,
                                 {entry.vertices, entry.fine_triangles}, start);
      check_block(model, entry, block, start.places.size(), number);
      fine_ends.push_back(block.fine);
      model.blocks.push_back(std::move(block));
      model.coarse.push_back(std::move(start));
    }
  }
  return model;
}

}  // namespace plain
