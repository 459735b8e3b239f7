// The plain definition of a level of detail, written to be read beside crease/contraction.h rather
// than to be fast.
#include "crease/contraction.h"

#include "base/assert.h"
#include "hierarchy/attribute_values.h"
#include "hierarchy/geometric_normal.h"

#include <algorithm>

namespace crease {

namespace {

using TrianglesAround = std::vector<std::vector<std::uint32_t>>;  // per vertex; also dead ones

bool has_corner_at(const Triangle& triangle, VertexId v) {
  return triangle[0] == v || triangle[1] == v || triangle[2] == v;
}

void replace_vertex(Level& level, TrianglesAround& around, VertexId p, VertexId q) {
  for (std::uint32_t t : around[index_of(p)]) {
    if (!level.alive[t]) continue;
    if (has_corner_at(level.triangles[t], q)) {
      level.alive[t] = false;
      continue;
    }
    std::replace(level.triangles[t].begin(), level.triangles[t].end(), p, q);
    around[index_of(q)].push_back(t);
  }
  around[index_of(p)].clear();
}

void change_attributes(Level& level, const std::vector<std::uint32_t>& around_q, VertexId q,
                       const AttributeChange& change, bool is_normal) {
  for (std::uint32_t t : around_q) {
    if (!level.alive[t] || (is_normal && level.derived[t])) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      AttributeId& attribute = level.of_corner[change.layer][3 * t + c];
      if (level.triangles[t][c] == q && attribute == change.from) attribute = change.to;
    }
  }
}

}  // namespace

Level apply_contractions(const Mesh& snapped, const ContractionSequence& sequence,
                         std::size_t count) {
  CREASE_ASSERT(count <= sequence.contractions.size());
  Level level;
  level.positions.reserve(snapped.vertex_count());
  for (const Vec3d& p : snapped.positions) level.positions.push_back(sequence.grid.nearest(p));
  level.triangles = snapped.triangles;
  level.alive.assign(snapped.triangle_count(), true);
  level.derived.assign(snapped.triangle_count(), false);
  for (const AttributeLayer& layer : snapped.layers) level.of_corner.push_back(layer.of_corner);

  TrianglesAround around(snapped.vertex_count());
  for (std::uint32_t t = 0; t < snapped.triangle_count(); ++t) {
    for (VertexId v : snapped.triangles[t]) around[index_of(v)].push_back(t);
  }

  for (std::size_t i = 0; i < count; ++i) {
    const Contraction& c = sequence.contractions[i];
    replace_vertex(level, around, c.removed, c.kept);
    level.positions[index_of(c.kept)] = c.position;
    for (TriangleId t : sequence.derived_of(c)) level.derived[index_of(t)] = true;
    for (const AttributeChange& change : sequence.changes_of(c)) {
      change_attributes(level, around[index_of(c.kept)], c.kept, change,
                        snapped.layers[change.layer].role == AttributeRole::Normal);
    }
  }
  return level;
}

namespace {

// The ids of a layer that a level uses, in the order of their first use.
class UsedValues {
 public:
  UsedValues(const AttributeLayer& source, const ContractionSequence& sequence, std::size_t layer)
      : source_(source), sequence_(sequence), layer_(layer) {
    new_of_old_.assign(source.value_count() + new_value_count(source, sequence, layer),
                       kNoAttribute);
  }
  AttributeId use(AttributeId old, AttributeLayer& target) {
    AttributeId& id = new_of_old_[index_of(old)];
    if (id == kNoAttribute) {
      id = AttributeId{static_cast<std::uint32_t>(target.value_count())};
      const std::span<const float> value = attribute_value(source_, sequence_, layer_, old);
      target.values.insert(target.values.end(), value.begin(), value.end());
    }
    return id;
  }

 private:
  const AttributeLayer& source_;
  const ContractionSequence& sequence_;
  std::size_t layer_;
  std::vector<AttributeId> new_of_old_;
};

void fill_layer(const Mesh& snapped, const ContractionSequence& sequence, const Level& level,
                std::size_t layer, AttributeLayer& target) {
  const AttributeLayer& source = snapped.layers[layer];
  target.name = source.name;
  target.role = source.role;
  target.interpolation = source.interpolation;
  target.dimension = source.dimension;
  UsedValues used(source, sequence, layer);
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    if (!level.alive[t]) continue;
    if (source.role == AttributeRole::Normal && level.derived[t]) {
      const auto [a, b, c] = level.triangles[t];
      const Vec3f n = geometric_normal(level.positions[index_of(a)], level.positions[index_of(b)],
                                       level.positions[index_of(c)]);
      if (n != Vec3f{}) {
        const AttributeId id{static_cast<std::uint32_t>(target.value_count())};
        target.values.insert(target.values.end(), {n.x, n.y, n.z});
        target.of_corner.insert(target.of_corner.end(), 3, id);
        continue;
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      target.of_corner.push_back(used.use(level.of_corner[layer][3 * t + c], target));
    }
  }
}

}  // namespace

Mesh mesh_of_level(const Mesh& snapped, const ContractionSequence& sequence, const Level& level) {
  Mesh mesh;
  mesh.materials = snapped.materials;
  mesh.parts = snapped.parts;
  mesh.up = snapped.up;
  std::vector<std::uint32_t> new_of_old(snapped.vertex_count(), kNone);
  for (std::size_t t = 0; t < level.triangles.size(); ++t) {
    if (!level.alive[t]) continue;
    Triangle triangle{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t old = index_of(level.triangles[t][c]);
      if (new_of_old[old] == kNone) {
        new_of_old[old] = static_cast<std::uint32_t>(mesh.vertex_count());
        mesh.positions.push_back(sequence.grid.position(level.positions[old]));
      }
      triangle[c] = VertexId{new_of_old[old]};
    }
    mesh.triangles.push_back(triangle);
    if (!snapped.material_of_triangle.empty()) {
      mesh.material_of_triangle.push_back(snapped.material_of_triangle[t]);
    }
    if (!snapped.part_of_triangle.empty()) {
      mesh.part_of_triangle.push_back(snapped.part_of_triangle[t]);
    }
  }
  mesh.layers.resize(snapped.layers.size());
  for (std::size_t l = 0; l < snapped.layers.size(); ++l) {
    fill_layer(snapped, sequence, level, l, mesh.layers[l]);
  }
  return mesh;
}

}  // namespace crease
