#include "runtime/extract_cut.h"

#include "runtime/cut_drawing.h"
#include "runtime/layer_like.h"

#include <algorithm>
#include <array>
#include <vector>

namespace crease {

namespace {

struct ActiveTriangle {
  TriangleId id{};
  Part part = kSnPart;
  std::uint32_t place = 0;
};

std::vector<ActiveTriangle> in_order(const ActiveCut& cut) {
  std::vector<ActiveTriangle> all;
  all.reserve(cut.triangle_count());
  for (const Part p : {kSnPart, kFnPart, kNsnPart}) {
    const ActiveTriangles& part = cut.parts()[p];
    for (std::uint32_t i = 0; i < part.size(); ++i) {
      all.push_back({part.ids[i], p, i});
    }
  }
  std::sort(all.begin(), all.end(),
            [](const ActiveTriangle& a, const ActiveTriangle& b) { return a.id < b.id; });
  return all;
}

void extract_vertices(const ActiveCut& cut, const std::vector<ActiveTriangle>& triangles,
                      CutPiece& piece) {
  Mesh& mesh = piece.mesh;
  const std::span<const ActiveVertex> vertices = cut.vertices();
  std::vector<std::uint32_t> order, vertex_of_slot(vertices.size(), kNone);
  for (const ActiveTriangle& t : triangles) {
    const std::uint32_t* const slots = &cut.parts()[t.part].slots[3 * std::size_t(t.place)];
    for (std::size_t k = 0; k < 3; ++k) {
      if (vertex_of_slot[slots[k]] == kNone) order.push_back(slots[k]);
      vertex_of_slot[slots[k]] = 0;
    }
  }
  std::sort(order.begin(), order.end(), [vertices](std::uint32_t a, std::uint32_t b) {
    return vertices[a].begin < vertices[b].begin;
  });
  for (const std::uint32_t slot : order) {
    vertex_of_slot[slot] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(cut.hierarchy().vertices.grid.position(vertices[slot].position));
    piece.node_of_vertex.push_back(vertices[slot].node);
  }
  for (const ActiveTriangle& t : triangles) {
    const std::uint32_t* const slots = &cut.parts()[t.part].slots[3 * std::size_t(t.place)];
    mesh.triangles.push_back({VertexId{vertex_of_slot[slots[0]]},
                              VertexId{vertex_of_slot[slots[1]]},
                              VertexId{vertex_of_slot[slots[2]]}});
  }
}

AttributeLayer extract_layer(const ActiveCut& cut, const std::vector<ActiveTriangle>& triangles,
                             std::uint32_t l) {
  const AttributeHierarchy& source = cut.hierarchy().layers[l];
  AttributeLayer layer = layer_like(source);
  const auto append = [&layer](const auto& value) {
    layer.values.insert(layer.values.end(), value.begin(), value.end());
    return static_cast<std::uint32_t>(layer.value_count() - 1);
  };
  std::vector<std::uint32_t> id_of_value(source.values.size(), kNone);
  for (const ActiveTriangle& t : triangles) {
    const ActiveTriangles& part = cut.parts()[t.part];
    if (l == cut.normal_layer() && part.is_derived[t.place] != 0) {
      const Vec3f n = geometric_normal_of(cut, part, t.place);
      if (n != Vec3f{}) {
        const std::array<float, 3> value{n.x, n.y, n.z};
        layer.of_corner.insert(layer.of_corner.end(), 3, AttributeId{append(value)});
        continue;
      }
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::size_t index = cut.value_index(part, 3 * t.place + k, l);
      if (id_of_value[index] == kNone) {
        id_of_value[index] = append(source.values[index]);
      }
      layer.of_corner.push_back(AttributeId{id_of_value[index]});
    }
  }
  return layer;
}

}  // namespace

Mesh extract_cut(const ActiveCut& cut) {
  return extract_piece(cut).mesh;
}

CutPiece extract_piece(const ActiveCut& cut) {
  const MeshHierarchy& hierarchy = cut.hierarchy();
  const std::vector<ActiveTriangle> triangles = in_order(cut);
  CutPiece piece;
  Mesh& mesh = piece.mesh;
  mesh.materials = hierarchy.materials;
  mesh.parts = hierarchy.parts;
  mesh.up = hierarchy.up;
  extract_vertices(cut, triangles, piece);
  for (std::uint32_t l = 0; l < hierarchy.layers.size(); ++l) {
    mesh.layers.push_back(extract_layer(cut, triangles, l));
  }
  const VertexHierarchy& h = hierarchy.vertices;
  for (const ActiveTriangle& t : triangles) {
    piece.id_of_triangle.push_back(t.id);
    if (!h.material_of_triangle.empty()) {
      mesh.material_of_triangle.push_back(h.material_of_triangle[index_of(t.id)]);
    }
    if (!h.part_of_triangle.empty()) {
      mesh.part_of_triangle.push_back(h.part_of_triangle[index_of(t.id)]);
    }
  }
  return piece;
}

}  // namespace crease
