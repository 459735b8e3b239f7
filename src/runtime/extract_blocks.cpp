#include "runtime/extract_blocks.h"

#include "codec/join_ends.h"
#include "runtime/extract_cut.h"
#include "runtime/join_meshes.h"

#include <unordered_map>
#include <utility>

namespace crease {

namespace {

std::uint64_t name_of(std::size_t block, std::size_t vertex) {
  return std::uint64_t(block) << 32 | vertex;
}

// A vertex of a cut is a node of the block that made it.
std::uint64_t name_of_node(const BlockMesh::Impl& mesh, const codec::VertexName& name) {
  const BlockCut* const cut = mesh.cuts.cut(name.block);
  return name_of(name.block,
                 cut == nullptr ? name.vertex : index_of(cut->data().leaf_of_vertex[name.vertex]));
}

// All blocks that are shown whole, together.
NamedMesh extract_whole(const BlockMesh::Impl& mesh) {
  std::vector<std::uint32_t> blocks;
  for (const std::uint32_t block : mesh.cut) {
    const bool is_whole = mesh.levels.shown(block) == kFullLevel;
    if (is_whole && mesh.cuts.cut(block) == nullptr) blocks.push_back(block);
  }
  NamedMesh whole;
  std::vector<codec::PatchMesh> ends;
  std::vector<codec::EndPiece> pieces;
  std::vector<codec::PlacedTriangle> triangles;
  std::vector<Vec3i> positions;
  std::vector<std::vector<std::uint32_t>> vertices(blocks.size());
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_name;
  for (std::uint32_t i = 0; i < blocks.size(); ++i) {
    codec::FineEnd end = mesh.resident[blocks[i]]->data().end.unpacked();
    vertices[i].assign(end.names.size(), kNone);
    for (std::uint32_t t = 0; t < end.labels.size(); ++t) {
      if (!mesh.is_shown(blocks[i], end.labels[t])) continue;
      triangles.push_back({i, t});
      for (const std::uint32_t v : end.mesh.triangles[t]) {
        if (vertices[i][v] != kNone) continue;
        const std::uint64_t name = name_of_node(mesh, end.names[v]);
        const auto [at, is_new] =
            vertex_of_name.try_emplace(name, static_cast<std::uint32_t>(positions.size()));
        if (is_new) {
          positions.push_back(end.mesh.positions[v]);
          whole.names.push_back(name);
        }
        vertices[i][v] = at->second;
      }
    }
    ends.push_back(std::move(end.mesh));
  }
  for (std::uint32_t i = 0; i < ends.size(); ++i) pieces.push_back({&ends[i], vertices[i]});
  codec::ModelSchema schema = *mesh.schema;
  schema.parts = mesh.part_names;
  codec::LayerPools layers(schema);
  whole.mesh = codec::join_ends(schema, pieces, triangles, positions, layers.pools());
  return whole;
}

NamedMesh extract_piece_of(const BlockMesh::Impl& mesh, const ActiveCut& cut,
                           const BlockHierarchy::Data& data, const ResidentBlock::Data& block) {
  CutPiece piece = extract_piece(cut);
  NamedMesh result{std::move(piece.mesh), {}};
  // A vertex of the coarse end that is not split is one of the block that made it.
  std::unordered_map<std::uint32_t, std::uint32_t> root_of_node;
  for (std::uint32_t r = 0; r < data.node_of_root.size(); ++r) {
    root_of_node[static_cast<std::uint32_t>(data.node_of_root[r])] = r;
  }
  for (const NodeId node : piece.node_of_vertex) {
    const auto root = root_of_node.find(static_cast<std::uint32_t>(node));
    const bool is_own = root == root_of_node.end() ||
                        block.root_names[root->second].block == index_of(block.entry.id);
    result.names.push_back(is_own ? name_of(index_of(block.entry.id), index_of(node))
                                  : name_of_node(mesh, block.root_names[root->second]));
  }
  if (mesh.part_names.empty()) return result;
  for (const TriangleId t : piece.id_of_triangle) {
    const std::uint32_t category = block.end.category(data.triangle_of[index_of(t)]);
    result.mesh.part_of_triangle.push_back(PartId{category / mesh.schema->coding.material_count});
  }
  return result;
}

// The hierarchy that its list was made of, once more.
NamedMesh extract_level(const BlockMesh::Impl& mesh, std::uint32_t block, const LevelList& list) {
  std::vector<ResidentBlockPtr> needed;
  for (const std::uint32_t n : mesh.graph.dependencies(block)) needed.push_back(mesh.resident[n]);
  const BlockHierarchyPtr hierarchy = make_tall_hierarchy(*mesh.resident[block], needed);
  ActiveCut cut(hierarchy->data().hierarchy);
  split_as(list, cut);
  return extract_piece_of(mesh, cut, hierarchy->data(), mesh.resident[block]->data());
}

}  // namespace

Mesh extract_blocks(const BlockMesh::Impl& mesh) {
  std::vector<NamedMesh> meshes;
  meshes.push_back(extract_whole(mesh));  // with materials and parts, if with no triangle
  for (const std::uint32_t block : mesh.cut) {
    const BlockCut* const cut = mesh.cuts.cut(block);
    if (const LevelList* const list = mesh.levels.list(block)) {
      meshes.push_back(extract_level(mesh, block, *list));
    } else if (cut != nullptr && cut->live() != nullptr) {
      meshes.push_back(
          extract_piece_of(mesh, *cut->live(), cut->data(), mesh.resident[block]->data()));
    }
  }
  return meshes.size() == 1 ? std::move(meshes[0].mesh) : join_meshes(meshes);
}

}  // namespace crease
