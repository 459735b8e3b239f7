#include "codec/join_ends.h"

#include "hierarchy/geometric_normal.h"
#include "mesh/corners_around.h"

#include <algorithm>

namespace crease::codec {

LayerPools::LayerPools(const ModelSchema& schema) {
  const std::vector<LayerSchema>& layers = schema.facts.layers;
  values_.reserve(layers.size());  // pools point into it
  for (std::size_t l = 0; l < layers.size(); ++l) {
    values_.emplace_back(schema.codings[l], layers[l].dimension);
    pools_.emplace_back(values_[l], layers[l].dimension);
  }
}

namespace {

class EndJoiner {
 public:
  EndJoiner(const ModelSchema& schema, std::span<const EndPiece> pieces,
            std::span<const PlacedTriangle> triangles, std::span<const Vec3i> positions)
      : schema_(schema), pieces_(pieces), triangles_(triangles), positions_(positions) {}

  Mesh run(std::vector<ValuePool>& pools) const {
    Mesh mesh;
    mesh.materials = schema_.materials;
    mesh.parts = schema_.parts;
    mesh.up = schema_.facts.up;
    mesh.positions.reserve(positions_.size());
    for (const Vec3i& p : positions_) mesh.positions.push_back(schema_.facts.grid.position(p));
    mesh.triangles.reserve(triangles_.size());
    for (const PlacedTriangle& at : triangles_) add_triangle(at, mesh);
    mesh.layers.resize(pools.size());
    const CornersAround around(mesh);
    for (std::size_t l = 0; l < pools.size(); ++l) {
      fill_layer(l, mesh, around, pools[l], mesh.layers[l]);
    }
    return mesh;
  }

 private:
  static constexpr std::size_t kMany = 32;  // corners of a vertex, to be compared each with each

  void add_triangle(const PlacedTriangle& at, Mesh& mesh) const {
    const EndPiece& piece = pieces_[at.piece];
    const Corners& corners = piece.end->triangles[at.triangle];
    mesh.triangles.push_back({VertexId{piece.vertices[corners[0]]},
                              VertexId{piece.vertices[corners[1]]},
                              VertexId{piece.vertices[corners[2]]}});
    const std::uint32_t category = piece.end->category[at.triangle];
    const std::uint32_t material_count = schema_.coding.material_count;
    if (!mesh.materials.empty()) {
      mesh.material_of_triangle.push_back(MaterialId{category % material_count});
    }
    if (!mesh.parts.empty()) mesh.part_of_triangle.push_back(PartId{category / material_count});
  }

  void fill_layer(std::size_t l, const Mesh& mesh, const CornersAround& around, ValuePool& pool,
                  AttributeLayer& layer) const {
    const LayerSchema& schema = schema_.facts.layers[l];
    layer.name = schema.name;
    layer.role = schema.role;
    layer.interpolation = schema.interpolation;
    layer.dimension = schema.dimension;
    const bool is_normal = schema.role == AttributeRole::Normal;
    const std::vector<char> is_flat = find_flat(l, is_normal, mesh, around);
    layer.of_corner.reserve(is_flat.size());
    for (std::uint32_t corner = 0; corner < is_flat.size(); ++corner) {
      const std::uint32_t vertex = vertex_of(mesh, corner);
      const std::uint32_t id =
          is_normal && is_derived(corner / 3)
              ? geometric_value(mesh.triangles[corner / 3], pool)
              : pool.intern(value_of(l, corner), is_flat[corner] ? ValuePool::kFlat : vertex);
      layer.of_corner.push_back(AttributeId{id});
    }
    layer.values = pool.numbers();
  }

  // Per corner, whether a triangle at its vertex has the value at all three corners.
  std::vector<char> find_flat(std::size_t l, bool is_normal, const Mesh& mesh,
                              const CornersAround& around) const {
    const auto is_hidden = [&](std::size_t t) { return is_normal && is_derived(t); };
    std::vector<char> is_flat(3 * triangles_.size(), 0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const CodedValue& first = value_of(l, 3 * t);
      if (is_hidden(t) || first != value_of(l, 3 * t + 1) || first != value_of(l, 3 * t + 2)) {
        continue;
      }
      std::fill_n(is_flat.begin() + 3 * std::ptrdiff_t(t), 3, 1);
    }
    std::vector<std::uint32_t> sorted;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const std::span<const std::uint32_t> corners = around.of(v);
      if (corners.size() > kMany) {
        sorted.assign(corners.begin(), corners.end());
        mark_like_flat(l, is_hidden, sorted, is_flat);
        continue;
      }
      for (const std::uint32_t corner : corners) {
        if (is_flat[corner] != 1) continue;
        for (const std::uint32_t other : corners) {
          // 2: as flat as that one, and no need to look around it again.
          if (!is_hidden(other / 3) && value_of(l, other) == value_of(l, corner)) {
            is_flat[other] = 2;
          }
        }
      }
    }
    return is_flat;
  }

  // The same for a vertex of many corners.
  template <typename IsHidden>
  void mark_like_flat(std::size_t l, IsHidden is_hidden, std::vector<std::uint32_t>& corners,
                      std::vector<char>& is_flat) const {
    std::erase_if(corners, [&](std::uint32_t corner) { return is_hidden(corner / 3); });
    std::sort(corners.begin(), corners.end(),
              [&](std::uint32_t a, std::uint32_t b) { return value_of(l, a) < value_of(l, b); });
    for (auto begin = corners.begin(); begin != corners.end();) {
      const auto end = std::find_if(begin, corners.end(), [&](std::uint32_t corner) {
        return value_of(l, corner) != value_of(l, *begin);
      });
      const bool any = std::any_of(begin, end, [&](std::uint32_t c) { return is_flat[c] != 0; });
      if (any) std::for_each(begin, end, [&](std::uint32_t corner) { is_flat[corner] = 2; });
      begin = end;
    }
  }

  // Where an end is coarser than the model, a triangle may show its geometric normal already.
  bool is_derived(std::size_t t) const {
    return pieces_[triangles_[t].piece].end->derived[triangles_[t].triangle] != 0;
  }
  const CodedValue& value_of(std::size_t l, std::uint32_t corner) const {
    const PlacedTriangle& at = triangles_[corner / 3];
    return pieces_[at.piece].end->values[l][3 * std::size_t(at.triangle) + corner % 3];
  }
  static std::uint32_t vertex_of(const Mesh& mesh, std::uint32_t corner) {
    return static_cast<std::uint32_t>(index_of(mesh.triangles[corner / 3][corner % 3]));
  }

  std::uint32_t geometric_value(const Triangle& triangle, ValuePool& pool) const {
    const Vec3f n =
        geometric_normal(positions_[index_of(triangle[0])], positions_[index_of(triangle[1])],
                         positions_[index_of(triangle[2])]);
    return pool.intern_direction(n == Vec3f{} ? Vec3f{0, 0, 1} : n);  // without area: any
  }

  const ModelSchema& schema_;
  std::span<const EndPiece> pieces_;
  std::span<const PlacedTriangle> triangles_;
  std::span<const Vec3i> positions_;
};

}  // namespace

Mesh join_ends(const ModelSchema& schema, std::span<const EndPiece> pieces,
               std::span<const PlacedTriangle> triangles, std::span<const Vec3i> positions,
               std::vector<ValuePool>& pools) {
  return EndJoiner(schema, pieces, triangles, positions).run(pools);
}

}  // namespace crease::codec
