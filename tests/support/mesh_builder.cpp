#include "support/mesh_builder.h"

namespace crease {

MeshBuilder::MeshBuilder() {
  mesh_.layers.push_back({.name = "normal",
                          .role = AttributeRole::Normal,
                          .interpolation = Interpolation::Direction,
                          .dimension = 3,
                          .values = {},
                          .of_corner = {}});
}

VertexId MeshBuilder::vertex(Vec3d p) {
  mesh_.positions.push_back(p);
  return VertexId(mesh_.positions.size() - 1);
}

VertexId MeshBuilder::at(Vec3d p) {
  const auto [found, is_new] = vertex_at_.try_emplace({p.x, p.y, p.z}, VertexId{});
  if (is_new) found->second = vertex(p);
  return found->second;
}

AttributeId MeshBuilder::normal(Vec3d n) {
  const Vec3d unit = normalized(n);
  AttributeLayer& layer = mesh_.layers[0];
  for (int i = 0; i < 3; ++i) layer.values.push_back(static_cast<float>(unit[i]));
  return AttributeId(layer.value_count() - 1);
}

AttributeId MeshBuilder::normal_at(Vec3d n) {
  const Vec3d unit = normalized(n);
  const std::array<float, 3> key{float(unit.x), float(unit.y), float(unit.z)};
  const auto [found, is_new] = normal_at_.try_emplace(key, AttributeId{});
  if (is_new) found->second = normal(n);
  return found->second;
}

void MeshBuilder::triangle(std::array<VertexId, 3> v, std::array<AttributeId, 3> n) {
  mesh_.triangles.push_back(v);
  std::vector<AttributeId>& of_corner = mesh_.layers[0].of_corner;
  of_corner.insert(of_corner.end(), n.begin(), n.end());
}

void MeshBuilder::flat_triangle(std::array<VertexId, 3> v) {
  const Vec3d a = position(v[0]);
  triangle(v, normal(cross(position(v[1]) - a, position(v[2]) - a)));
}

void MeshBuilder::quad(std::array<VertexId, 4> v, std::array<AttributeId, 4> n) {
  triangle({v[0], v[1], v[2]}, {n[0], n[1], n[2]});
  triangle({v[0], v[2], v[3]}, {n[0], n[2], n[3]});
}

void MeshBuilder::grid(Vec3d origin, Vec3d u, Vec3d v, int columns, int rows) {
  const AttributeId n = normal(cross(u, v));
  // The far ends are hit exactly, so that grids that share an edge share its vertices.
  const auto point = [&](int column, int row) {
    return at(origin + u * (double(column) / columns) + v * (double(row) / rows));
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      quad({point(column, row), point(column + 1, row), point(column + 1, row + 1),
            point(column, row + 1)},
           n);
    }
  }
}

void MeshBuilder::box(Vec3d low, Vec3d high, int cells) {
  const Vec3d size = high - low;
  const Vec3d x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  // A lattice computed once: opposite sides reach their common corners by different sums otherwise.
  const auto point = [&](int i, int j, int k) {
    return Vec3d{i == cells ? high.x : low.x + x.x * i / cells,
                 j == cells ? high.y : low.y + y.y * j / cells,
                 k == cells ? high.z : low.z + z.z * k / cells};
  };
  struct Side {
    int fixed, value;  // the axis that is constant, and at which lattice value
    int u, v;          // the axes that run, u x v outwards
  };
  const Side sides[] = {{0, 0, 2, 1},     {0, cells, 1, 2}, {1, 0, 0, 2},
                        {1, cells, 2, 0}, {2, 0, 1, 0},     {2, cells, 0, 1}};
  for (const Side& side : sides) {
    Vec3d outwards;
    outwards[side.fixed] = side.value == 0 ? -1 : 1;
    const AttributeId n = normal(outwards);
    const auto corner = [&](int a, int b) {
      int lattice[3];
      lattice[side.fixed] = side.value;
      lattice[side.u] = a;
      lattice[side.v] = b;
      return at(point(lattice[0], lattice[1], lattice[2]));
    };
    for (int b = 0; b < cells; ++b) {
      for (int a = 0; a < cells; ++a) {
        quad({corner(a, b), corner(a + 1, b), corner(a + 1, b + 1), corner(a, b + 1)}, n);
      }
    }
  }
}

}  // namespace crease
