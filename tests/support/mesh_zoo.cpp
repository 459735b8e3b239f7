#include "support/mesh_zoo.h"

#include "support/mesh_builder.h"

#include <utility>

namespace crease {

namespace {

// -1..1 from an integer, the same everywhere (splitmix64).
double noise(std::uint64_t seed) {
  std::uint64_t z = (seed + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return double((z ^ (z >> 31)) >> 11) * (2.0 / 9007199254740992.0) - 1.0;
}

void flat_tetrahedron(MeshBuilder& b, std::array<VertexId, 4> v) {
  b.flat_triangle({v[0], v[2], v[1]});
  b.flat_triangle({v[0], v[1], v[3]});
  b.flat_triangle({v[1], v[2], v[3]});
  b.flat_triangle({v[2], v[0], v[3]});
}

Mesh single_triangle() {
  MeshBuilder b;
  b.flat_triangle({b.vertex({0, 0, 0}), b.vertex({1, 0, 0}), b.vertex({0, 1, 0})});
  return b.take();
}

Mesh three_triangles_on_an_edge() {
  MeshBuilder b;
  const VertexId p = b.vertex({0, 0, 0}), q = b.vertex({0, 0, 1});
  b.flat_triangle({p, q, b.vertex({1, 0, 0.5})});
  b.flat_triangle({p, q, b.vertex({-0.5, 0.8, 0.5})});
  b.flat_triangle({p, q, b.vertex({-0.5, -0.8, 0.5})});
  return b.take();
}

// Two fans that meet in nothing but one vertex, at which they share a normal.
Mesh bow_tie() {
  MeshBuilder b;
  const AttributeId up = b.normal({0, 0, 1});
  const VertexId knot = b.vertex({0, 0, 0});
  for (double x : {1.0, -1.0}) {
    const VertexId low = b.vertex({x, -x, 0}), middle = b.vertex({x, 0, 0}),
                   high = b.vertex({x, x, 0});
    b.triangle({knot, low, middle}, up);
    b.triangle({knot, middle, high}, up);
  }
  return b.take();
}

Mesh two_tetrahedra(int shared_vertices) {
  MeshBuilder b;
  const VertexId v[] = {b.vertex({0, 0, 0}), b.vertex({1, 0, 0}), b.vertex({0, 1, 0}),
                        b.vertex({0.3, 0.3, 1})};
  flat_tetrahedron(b, {v[0], v[1], v[2], v[3]});
  const Vec3d others[] = {{-1, -0.2, -0.3}, {0.4, -1, -0.2}, {0.2, 0.2, -1}};
  // Shared vertices come from the first; all three: the common face is there twice.
  std::array<VertexId, 4> w{v[0], v[0], v[0], b.vertex({-0.6, -0.7, -1.2})};
  for (int i = 0; i < 3; ++i) w[std::size_t(i)] = i < shared_vertices ? v[i] : b.vertex(others[i]);
  std::swap(w[1], w[2]);  // the other side of the common face
  flat_tetrahedron(b, w);
  return b.take();
}

Mesh duplicate_triangles() {
  MeshBuilder b;
  const VertexId v[] = {b.vertex({0, 0, 0}), b.vertex({1, 0, 0}), b.vertex({1, 1, 0}),
                        b.vertex({0, 1, 0})};
  b.flat_triangle({v[0], v[1], v[2]});
  b.flat_triangle({v[0], v[1], v[2]});
  b.flat_triangle({v[1], v[2], v[0]});  // the same, told from another corner
  b.flat_triangle({v[0], v[2], v[1]});  // the other way round
  b.flat_triangle({v[0], v[2], v[3]});
  b.flat_triangle({v[0], v[3], v[2]});
  return b.take();
}

// A flat square whose middle holds triangles without area: collinear corners, and corners at one
// position though they are different vertices.
Mesh zero_area_triangles() {
  MeshBuilder b;
  const AttributeId up = b.normal({0, 0, 1});
  const VertexId v[] = {b.vertex({0, 0, 0}), b.vertex({2, 0, 0}), b.vertex({2, 2, 0}),
                        b.vertex({0, 2, 0}), b.vertex({1, 1, 0}), b.vertex({1, 1, 0})};
  b.triangle({v[0], v[1], v[4]}, up);
  b.triangle({v[1], v[2], v[4]}, up);
  b.triangle({v[2], v[3], v[5]}, up);
  b.triangle({v[3], v[0], v[5]}, up);
  b.triangle({v[0], v[4], v[5]}, up);  // two corners at one position
  b.triangle({v[2], v[5], v[4]}, up);
  b.triangle({v[0], v[4], v[2]}, up);  // collinear
  return b.take();
}

Mesh two_material_box() {
  Mesh mesh = hard_box(4);
  mesh.materials = {
      {.name = "brick", .base_color = {0.6f, 0.2f, 0.1f, 1}, .base_color_texture = ""},
      {.name = "tile", .base_color = {0.2f, 0.2f, 0.3f, 1}, .base_color_texture = ""}};
  mesh.parts = {"left", "right"};
  for (const Triangle& t : mesh.triangles) {
    Vec3d middle;
    for (VertexId v : t) middle += mesh.positions[index_of(v)] * (1.0 / 3);
    mesh.material_of_triangle.push_back(MaterialId(middle.z > 0.5));
    mesh.part_of_triangle.push_back(PartId(middle.x > 0.5));
  }
  return mesh;
}

Mesh coloured_sphere() {
  Mesh mesh = smooth_sphere(12, 16);
  AttributeLayer color{.name = "color",
                       .role = AttributeRole::Color,
                       .interpolation = Interpolation::Linear,
                       .dimension = 4,
                       .values = {},
                       .of_corner = {}};
  for (const Vec3d& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) color.values.push_back(float(0.5 + 0.5 * p[i]));
    color.values.push_back(1);
  }
  for (const Triangle& t : mesh.triangles) {
    for (VertexId v : t) color.of_corner.push_back(AttributeId(index_of(v)));
  }
  mesh.layers.push_back(std::move(color));
  return mesh;
}

// A smooth sphere whose halves are of different category: a crease that no normal shows.
Mesh categorical_sphere() {
  Mesh mesh = smooth_sphere(12, 16);
  AttributeLayer half{.name = "half",
                      .role = AttributeRole::Other,
                      .interpolation = Interpolation::Categorical,
                      .dimension = 1,
                      .values = {1, 2},
                      .of_corner = {}};
  for (const Triangle& t : mesh.triangles) {
    double x = 0;
    for (VertexId v : t) x += mesh.positions[index_of(v)].x;
    for (int c = 0; c < 3; ++c) half.of_corner.push_back(AttributeId(x > 0));
  }
  mesh.layers.push_back(std::move(half));
  return mesh;
}

Mesh cube_and_far_cube() {
  MeshBuilder b;
  b.box({0, 0, 0}, {1, 1, 1}, 2);
  b.box({1000, 1000, 0}, {1001, 1001, 1}, 2);
  return b.take();
}

Mesh unused_values() {
  MeshBuilder b;
  b.normal({1, 2, 3});
  b.box({0, 0, 0}, {1, 1, 1}, 2);
  b.normal({0, 0, -1});
  b.normal({3, 2, 1});
  return b.take();
}

Mesh isolated_vertex() {
  MeshBuilder b;
  b.vertex({5, 5, 5});
  b.box({0, 0, 0}, {1, 1, 1}, 2);
  return b.take();
}

}  // namespace

Mesh hard_box(int cells) {
  MeshBuilder b;
  b.box({0, 0, 0}, {1, 1, 1}, cells);
  return b.take();
}

Mesh noisy_box(int cells, double noise_deg) {
  Mesh mesh = hard_box(cells);
  AttributeLayer& layer = *mesh.normals();
  std::vector<float> values;
  for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
    const std::span<const float> side = layer.value(layer.of_corner[corner]);
    Vec3d n{side[0], side[1], side[2]};
    // Two tangents of the side; together they tilt by at most noise_deg.
    const Vec3d u{n.y, n.z, n.x}, v = cross(n, u);
    const double tilt = std::tan(radians(noise_deg)) / std::sqrt(2.0);
    n = normalized(n + u * (tilt * noise(2 * corner)) + v * (tilt * noise(2 * corner + 1)));
    for (int i = 0; i < 3; ++i) values.push_back(float(n[i]));
    layer.of_corner[corner] = AttributeId(corner);
  }
  layer.values = std::move(values);
  return mesh;
}

Mesh crossing_walls(int walls, int cells) {
  MeshBuilder b;
  const int across = (walls + 1) * cells;
  for (int wall = 1; wall <= walls; ++wall) {
    for (int axis = 0; axis < 2; ++axis) {
      Vec3d facing;
      facing[axis] = 1;
      const AttributeId n = b.normal(facing);
      const auto point = [&](int along, int up) {
        Vec3d p{0, 0, double(up) / cells};
        p[axis] = wall;
        p[1 - axis] = double(along) / cells;
        return b.at(p);
      };
      for (int up = 0; up < cells; ++up) {
        for (int along = 0; along < across; ++along) {
          const VertexId p = point(along, up), q = point(along + 1, up),
                         r = point(along + 1, up + 1), s = point(along, up + 1);
          axis == 0 ? b.quad({p, q, r, s}, n) : b.quad({q, p, s, r}, n);
        }
      }
    }
  }
  return b.take();
}

Mesh gear(int teeth) {
  MeshBuilder b;
  const int points = 4 * teeth;
  const auto rim = [&](int i, double z) {
    // Foot, foot, head, head: flanks between them.
    const double radius = (i % 4) / 2 == 0 ? 0.85 : 1.0;
    const double angle = 2 * kPi * (i % points) / points;
    return b.at({radius * std::cos(angle), radius * std::sin(angle), z});
  };
  const AttributeId up = b.normal({0, 0, 1}), down = b.normal({0, 0, -1});
  const VertexId top = b.at({0, 0, 0.25}), bottom = b.at({0, 0, 0});
  for (int i = 0; i < points; ++i) {
    const VertexId p = rim(i, 0), q = rim(i + 1, 0), r = rim(i + 1, 0.25), s = rim(i, 0.25);
    b.quad({p, q, r, s}, b.normal(cross(b.position(q) - b.position(p), Vec3d{0, 0, 1})));
    b.triangle({top, s, r}, up);
    b.triangle({bottom, q, p}, down);
  }
  return b.take();
}

// Each corner of the box is cut off, its three points have the normals of their sides, and the
// bevels between the sides interpolate: flat sides, round edges, as artists model them.
Mesh bevelled_box() {
  MeshBuilder b;
  VertexId vertex[8][3];
  AttributeId normal[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      Vec3d n;
      n[axis] = end == 0 ? -1 : 1;
      normal[axis][end] = b.normal(n);
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d p;
      for (int i = 0; i < 3; ++i) p[i] = ((corner >> i & 1) == 0 ? -1 : 1) * (i == axis ? 1 : 0.8);
      vertex[corner][axis] = b.vertex(p);
    }
  }
  const auto end_of = [](int corner, int axis) { return corner >> axis & 1; };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    const int u_axis = (axis + 1) % 3, v_axis = (axis + 2) % 3;
    for (int end = 0; end < 2; ++end) {  // the side at this end of the axis
      const int c = end << axis;
      const AttributeId n = normal[axis][end];
      const VertexId p = vertex[c][axis], q = vertex[c | u][axis], r = vertex[c | u | v][axis],
                     s = vertex[c | v][axis];
      end == 1 ? b.quad({p, q, r, s}, n) : b.quad({p, s, r, q}, n);
    }
    for (int edge = 0; edge < 4; ++edge) {  // the bevel along the axis, between sides u and v
      const int c = (edge & 1 ? u : 0) | (edge & 2 ? v : 0), d = c | 1 << axis;
      const AttributeId nu = normal[u_axis][end_of(c, u_axis)];
      const AttributeId nv = normal[v_axis][end_of(c, v_axis)];
      const bool outwards = edge == 1 || edge == 2;
      const VertexId p = vertex[c][u_axis], q = vertex[c][v_axis], r = vertex[d][v_axis],
                     s = vertex[d][u_axis];
      outwards ? b.quad({p, s, r, q}, {nu, nu, nv, nv}) : b.quad({p, q, r, s}, {nu, nv, nv, nu});
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    const bool mirrored = ((corner & 1) + (corner >> 1 & 1) + (corner >> 2)) % 2 == 0;
    const int i = mirrored ? 2 : 1, j = mirrored ? 1 : 2;
    b.triangle(
        {vertex[corner][0], vertex[corner][i], vertex[corner][j]},
        {normal[0][end_of(corner, 0)], normal[i][end_of(corner, i)], normal[j][end_of(corner, j)]});
  }
  return b.take();
}

Mesh city_blocks(int blocks, int cells) {
  MeshBuilder b;
  for (int j = 0; j < blocks; ++j) {
    for (int i = 0; i < blocks; ++i) {
      const double height = 1 + (i * 5 + j * 3) % 4;
      b.box({2.0 * i, 2.0 * j, 0}, {2.0 * i + 1, 2.0 * j + 1, height}, cells);
    }
  }
  return b.take();
}

// Rays run up and down in turn, so every sector between two of them is a plane of its own.
Mesh sector_fan(int sectors, int rings) {
  MeshBuilder b;
  const VertexId middle = b.at({0, 0, 0});
  const auto ray = [&](int i) {
    const double angle = 2 * kPi * (i % sectors) / sectors;
    return Vec3d{std::cos(angle), std::sin(angle), i % 2 == 0 ? 0.3 : -0.3};
  };
  for (int s = 0; s < sectors; ++s) {
    const Vec3d from = ray(s), to = ray((s + 1) % sectors);
    const AttributeId n = b.normal(cross(from, to));
    const auto point = [&](int ring, int step) {  // ring r has r steps from `from` to `to`
      if (step == 0) return b.at(from * (double(ring) / rings));
      if (step == ring) return b.at(to * (double(ring) / rings));
      return b.at(from * (double(ring - step) / rings) + to * (double(step) / rings));
    };
    for (int r = 1; r <= rings; ++r) {
      for (int k = 0; k < r; ++k) {
        const VertexId inner = r == 1 ? middle : point(r - 1, k);
        b.triangle({inner, point(r, k), point(r, k + 1)}, n);
        if (k + 1 < r) b.triangle({inner, point(r, k + 1), point(r - 1, k + 1)}, n);
      }
    }
  }
  return b.take();
}

std::vector<ZooMesh> mesh_zoo() {
  std::vector<ZooMesh> zoo;
  const auto add = [&](const char* name, Mesh mesh) { zoo.push_back({name, std::move(mesh)}); };
  add("smooth sphere", smooth_sphere(12, 16));
  add("faceted sphere", faceted_sphere(12, 16));
  add("hard box", hard_box(5));
  add("hard cylinder", hard_cylinder(24, 4));
  add("crossing walls", crossing_walls(3, 3));
  add("height field", height_field(16));
  add("torus", torus(24, 12));
  add("gear", gear(40));
  add("bevelled box", bevelled_box());
  add("noisy box", noisy_box(4, 0.5));
  add("two-material box", two_material_box());
  add("coloured sphere", coloured_sphere());
  add("categorical sphere", categorical_sphere());
  add("sector fan", sector_fan(12, 4));
  add("city blocks", city_blocks(6, 2));
  add("cone", cone(16, 4));
  add("moebius strip", moebius_strip(24));
  add("single triangle", single_triangle());
  add("three triangles on an edge", three_triangles_on_an_edge());
  add("bow-tie vertex", bow_tie());
  add("tetrahedra that share a vertex", two_tetrahedra(1));
  add("tetrahedra that share an edge", two_tetrahedra(2));
  add("tetrahedra that share a face", two_tetrahedra(3));
  add("duplicate triangles", duplicate_triangles());
  add("zero-area triangles", zero_area_triangles());
  add("cube and far cube", cube_and_far_cube());
  add("unused values", unused_values());
  add("isolated vertex", isolated_vertex());
  add("empty", MeshBuilder().take());
  return zoo;
}

}  // namespace crease
