#include "runtime/join_meshes.h"

#include "runtime/layer_like.h"

#include <algorithm>
#include <bit>
#include <unordered_map>

namespace crease {

namespace {

// A value at a vertex of the joined mesh: where it was seen first.
struct SeenValue {
  std::size_t mesh = 0;
  std::uint32_t id = 0;
};

bool have_same_bits(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  });
}

class MeshJoiner {
 public:
  explicit MeshJoiner(std::span<const NamedMesh> meshes) : meshes_(meshes) {}

  Mesh run() {
    joined_.materials = meshes_[0].mesh.materials;
    joined_.parts = meshes_[0].mesh.parts;
    joined_.up = meshes_[0].mesh.up;
    for (const NamedMesh& piece : meshes_) add_triangles(piece);
    for (std::size_t l = 0; l < meshes_[0].mesh.layers.size(); ++l) join_layer(l);
    return std::move(joined_);
  }

 private:
  void add_triangles(const NamedMesh& piece) {
    std::vector<std::uint32_t>& vertices = vertices_.emplace_back();
    for (std::size_t v = 0; v < piece.names.size(); ++v) {
      const auto [at, is_new] = vertex_of_name_.try_emplace(
          piece.names[v], static_cast<std::uint32_t>(joined_.positions.size()));
      if (is_new) joined_.positions.push_back(piece.mesh.positions[v]);
      vertices.push_back(at->second);
    }
    for (const Triangle& t : piece.mesh.triangles) {
      Triangle& triangle = joined_.triangles.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) triangle[c] = VertexId{vertices[index_of(t[c])]};
    }
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(joined_.material_of_triangle, piece.mesh.material_of_triangle);
    append(joined_.part_of_triangle, piece.mesh.part_of_triangle);
  }

  void join_layer(std::size_t l) {
    offsets_.assign(1, 0);
    for (const NamedMesh& piece : meshes_) {
      offsets_.push_back(offsets_.back() +
                         static_cast<std::uint32_t>(piece.mesh.layers[l].value_count()));
    }
    same_.resize(offsets_.back());
    for (std::uint32_t i = 0; i < same_.size(); ++i) same_[i] = i;
    std::vector<std::vector<SeenValue>> at_vertex(joined_.positions.size());
    for (std::size_t m = 0; m < meshes_.size(); ++m) find_same(l, m, at_vertex);
    AttributeLayer& layer = joined_.layers.emplace_back(layer_like(meshes_[0].mesh.layers[l]));
    std::vector<std::uint32_t> id_of(same_.size(), kNone);
    for (std::size_t m = 0; m < meshes_.size(); ++m) {
      const AttributeLayer& from = meshes_[m].mesh.layers[l];
      for (const AttributeId a : from.of_corner) {
        std::uint32_t& id = id_of[root(offsets_[m] + static_cast<std::uint32_t>(index_of(a)))];
        if (id == kNone) {
          id = static_cast<std::uint32_t>(layer.value_count());
          const std::span<const float> value = from.value(a);
          layer.values.insert(layer.values.end(), value.begin(), value.end());
        }
        layer.of_corner.push_back(AttributeId{id});
      }
    }
  }

  void find_same(std::size_t l, std::size_t m, std::vector<std::vector<SeenValue>>& at_vertex) {
    const Mesh& mesh = meshes_[m].mesh;
    for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
      const VertexId v = mesh.triangles[corner / 3][corner % 3];
      const AttributeId a = mesh.layers[l].of_corner[corner];
      const auto id = static_cast<std::uint32_t>(index_of(a));
      std::vector<SeenValue>& seen = at_vertex[vertices_[m][index_of(v)]];
      bool is_known = false;
      for (const SeenValue& s : seen) {
        is_known |= s.mesh == m && s.id == id;
        if (s.mesh == m) continue;
        const std::span<const float> other =
            meshes_[s.mesh].mesh.layers[l].value(AttributeId{s.id});
        if (have_same_bits(other, mesh.layers[l].value(a))) {
          same_[root(offsets_[m] + id)] = root(offsets_[s.mesh] + s.id);
        }
      }
      if (!is_known) seen.push_back({m, id});
    }
  }

  std::uint32_t root(std::uint32_t i) {
    while (same_[i] != i) i = same_[i] = same_[same_[i]];
    return i;
  }

  std::span<const NamedMesh> meshes_;
  Mesh joined_;
  std::vector<std::vector<std::uint32_t>> vertices_;  // per mesh and vertex
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_of_name_;
  std::vector<std::uint32_t> offsets_, same_;  // of one layer: attributes of all meshes in a row
};

}  // namespace

Mesh join_meshes(std::span<const NamedMesh> meshes) {
  return MeshJoiner(meshes).run();
}

}  // namespace crease
