#include "plain_decoder/block.h"

#include "plain_decoder/block_decoder.h"
#include "plain_decoder/directions.h"

#include <map>
#include <set>
#include <utility>

namespace plain {

// "Coarse end".
std::vector<End> coarse_ends(const std::vector<End>& fine_ends, std::size_t patches) {
  std::vector<End> result(patches);
  std::vector<std::map<Name, std::uint32_t>> number_of(patches);  // per patch: of a vertex
  for (const End& fine : fine_ends) {
    for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
      const std::uint32_t patch = fine.labels[t];
      if (patch >= patches) continue;
      End& coarse = result[patch];
      Triangle triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = fine.triangles[t][c];
        const auto next = static_cast<std::uint32_t>(coarse.places.size());
        const auto [found, is_new] = number_of[patch].try_emplace(fine.names[v], next);
        if (is_new) {
          coarse.places.push_back(fine.places[v]);
          coarse.names.push_back(fine.names[v]);
        }
        triangle[c] = found->second;
      }
      coarse.triangles.push_back(triangle);
      coarse.categories.push_back(fine.categories[t]);
      coarse.derived.push_back(fine.derived[t]);
      coarse.codes.resize(fine.codes.size());
      for (std::size_t l = 0; l < fine.codes.size(); ++l) {
        for (std::size_t c = 0; c < 3; ++c) {
          coarse.codes[l].push_back(fine.codes[l][3 * t + c]);
        }
      }
    }
  }
  return result;
}

// "Roots". The names of those that a coarser block has made; others have that of this block.
void read_roots(RangeDecoder& in, BlockState& block) {
  Magnitude count, triangle_count, name_block, name_vertex;
  std::array<Signed, 3> differences;
  AdaptiveBit has_name;
  const std::uint32_t roots = count.read(in), triangles = triangle_count.read(in);
  demand(roots <= block.limits.vertices - block.coarse_vertices, "more vertices than there are");
  demand(triangles <= block.limits.triangles - block.coarse_triangles,
         "more triangles than there are");
  Surface& surface = block.surface;
  Point last = surface.places.empty() ? Point{} : surface.places[0];
  for (std::uint32_t i = 0; i < roots; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      last.along(k) = sum_of(last.along(k), differences[k].read(in));
    }
    const Name own{block.number, block.coarse_vertices + i};
    Name name = own;
    if (has_name.read(in)) {
      name.block = name_block.read(in);
      name.vertex = name_vertex.read(in);
      demand(name.block < block.number || name == own, "a vertex of a block that is not coarser");
    }
    surface.add_vertex(last);
    block.end.names.push_back(name);
  }
  for (std::uint32_t i = 0; i < triangles; ++i) {
    Triangle t{};
    for (std::uint32_t& v : t) v = in.index(surface.places.size());
    demand(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "a triangle with one vertex twice");
    surface.add_triangle(t);
  }
}

namespace {

// "Names". Those of roots are there already.
void name_vertices(BlockState& block) {
  std::vector<Name>& names = block.end.names;
  const std::size_t known = names.size();
  names.resize(block.surface.places.size());
  for (std::uint32_t v = 0; v < names.size(); ++v) {
    const bool is_root = v >= block.coarse_vertices && v < known;
    if (!is_root && block.is_split_or_root(v)) names[v] = {block.number, v};
  }
  demand(std::set<Name>(names.begin(), names.end()).size() == names.size(),
         "two vertices with one name");
}

}  // namespace

// "The parts of a payload".
Block decode_block(std::span<const std::byte> payload, std::uint32_t number,
                   const BlockSchema& schema, const Limits& limits, const End& coarse) {
  demand(coarse.places.size() <= limits.vertices, "more vertices than there are");
  demand(coarse.triangles.size() <= limits.triangles, "more triangles than there are");
  BlockState block(schema, limits, number);
  block.end = coarse;
  block.end.labels.clear();
  for (const Point& place : coarse.places) block.surface.add_vertex(place);
  for (const Triangle& triangle : coarse.triangles) block.surface.add_triangle(triangle);
  block.coarse_vertices = static_cast<std::uint32_t>(coarse.places.size());
  block.coarse_triangles = static_cast<std::uint32_t>(coarse.triangles.size());
  block.was_derived = coarse.derived;
  block.coarse_place = block.surface.places;
  block.coarse_normal = normals_of_vertices(block.surface);

  RangeDecoder in(payload);
  read_roots(in, block);
  read_splits(in, block);
  read_categories(in, block);
  read_derived(in, block);
  block.end.codes.resize(schema.layers.size());
  for (std::size_t l = 0; l < schema.layers.size(); ++l) {
    read_layer(in, block, schema.layers[l], block.end.codes[l]);
  }
  read_labels(in, block);
  name_vertices(block);
  block.end.places = std::move(block.surface.places);
  block.end.triangles = std::move(block.surface.triangles);
  return {std::move(block.end), std::move(block.splits)};
}

}  // namespace plain
