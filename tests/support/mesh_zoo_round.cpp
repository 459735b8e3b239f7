// The zoo's round meshes: smooth or faceted surfaces of revolution and their like.
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

namespace crease {

namespace {

// Calls `triangle` with (ring, segment) corners of a sphere's triangles; segments wrap around.
template <typename AddTriangle>
void for_sphere_triangles(int rings, int segments, const AddTriangle& triangle) {
  struct Corner {
    int ring, segment;
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const Corner a{r, s}, b{r + 1, s}, c{r + 1, (s + 1) % segments}, d{r, (s + 1) % segments};
      if (r + 1 < rings) triangle(a, b, c);
      if (r > 0) triangle(a, c, d);
    }
  }
}

Vec3d on_sphere(int ring, int segment, int rings, int segments) {
  if (ring == 0) return {0, 0, 1};
  if (ring == rings) return {0, 0, -1};
  const double polar = kPi * ring / rings, around = 2 * kPi * segment / segments;
  return {std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around), std::cos(polar)};
}

Vec3d on_circle(int segment, int segments) {
  const double angle = 2 * kPi * segment / segments;
  return {std::cos(angle), std::sin(angle), 0};
}

}  // namespace

Mesh smooth_sphere(int rings, int segments) {
  MeshBuilder b;
  std::vector<VertexId> vertex;
  std::vector<AttributeId> normal;
  for (int i = 0; i < 2 + (rings - 1) * segments; ++i) {
    const int ring = i == 0 ? 0 : 1 + (i - 1) / segments;
    const Vec3d p = on_sphere(ring, i == 0 ? 0 : (i - 1) % segments, rings, segments);
    vertex.push_back(b.vertex(p));
    normal.push_back(b.normal(p));
  }
  const auto index = [&](auto corner) {
    if (corner.ring == 0) return std::size_t(0);
    if (corner.ring == rings) return vertex.size() - 1;
    return std::size_t(1 + (corner.ring - 1) * segments + corner.segment);
  };
  for_sphere_triangles(rings, segments, [&](auto p, auto q, auto r) {
    const std::size_t i = index(p), j = index(q), k = index(r);
    b.triangle({vertex[i], vertex[j], vertex[k]}, {normal[i], normal[j], normal[k]});
  });
  return b.take();
}

Mesh faceted_sphere(int rings, int segments) {
  MeshBuilder b;
  const auto vertex = [&](auto corner) {
    return b.at(on_sphere(corner.ring, corner.segment, rings, segments));
  };
  for_sphere_triangles(rings, segments, [&](auto p, auto q, auto r) {
    b.flat_triangle({vertex(p), vertex(q), vertex(r)});
  });
  return b.take();
}

Mesh hard_cylinder(int segments, int rings) {
  MeshBuilder b;
  const auto vertex = [&](int ring, int segment) {
    return b.at(on_circle(segment % segments, segments) + Vec3d{0, 0, 2.0 * ring / rings});
  };
  std::vector<AttributeId> side;
  for (int s = 0; s < segments; ++s) side.push_back(b.normal(on_circle(s, segments)));
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const AttributeId here = side[std::size_t(s)], next = side[std::size_t((s + 1) % segments)];
      b.quad({vertex(r, s), vertex(r, s + 1), vertex(r + 1, s + 1), vertex(r + 1, s)},
             {here, next, next, here});
    }
  }
  const AttributeId up = b.normal({0, 0, 1}), down = b.normal({0, 0, -1});
  const VertexId top = b.at({0, 0, 2}), bottom = b.at({0, 0, 0});
  for (int s = 0; s < segments; ++s) {
    b.triangle({top, vertex(rings, s), vertex(rings, s + 1)}, up);
    b.triangle({bottom, vertex(0, s + 1), vertex(0, s)}, down);
  }
  return b.take();
}

Mesh cone(int segments, int rings) {
  MeshBuilder b;
  const auto vertex = [&](int ring, int segment) {
    const double height = 2.0 * ring / rings;
    return b.at(on_circle(segment % segments, segments) * (1 - height / 2) + Vec3d{0, 0, height});
  };
  // Radius 1 over height 2: the side leans outwards by 1 in 2.
  const auto lean = [&](double s) {
    const double angle = 2 * kPi * s / segments;
    return Vec3d{std::cos(angle), std::sin(angle), 0.5};
  };
  std::vector<AttributeId> side;
  for (int s = 0; s < segments; ++s) side.push_back(b.normal(lean(s)));
  const VertexId tip = b.at({0, 0, 2});
  for (int s = 0; s < segments; ++s) {
    const AttributeId here = side[std::size_t(s)], next = side[std::size_t((s + 1) % segments)];
    for (int r = 0; r + 1 < rings; ++r) {
      b.quad({vertex(r, s), vertex(r, s + 1), vertex(r + 1, s + 1), vertex(r + 1, s)},
             {here, next, next, here});
    }
    b.triangle({vertex(rings - 1, s), vertex(rings - 1, s + 1), tip},
               {here, next, b.normal(lean(s + 0.5))});
  }
  const AttributeId down = b.normal({0, 0, -1});
  const VertexId bottom = b.at({0, 0, 0});
  for (int s = 0; s < segments; ++s) b.triangle({bottom, vertex(0, s + 1), vertex(0, s)}, down);
  return b.take();
}

Mesh torus(int rings, int segments) {
  MeshBuilder b;
  std::vector<VertexId> vertex;
  std::vector<AttributeId> normal;
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const double tube = 2 * kPi * s / segments;
      const Vec3d out = on_circle(r, rings);
      const Vec3d n = out * std::cos(tube) + Vec3d{0, 0, std::sin(tube)};
      vertex.push_back(b.vertex(out * 2.0 + n * 0.75));
      normal.push_back(b.normal(n));
    }
  }
  const auto index = [&](int r, int s) {
    return std::size_t((r % rings) * segments + s % segments);
  };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      const std::size_t i = index(r, s), j = index(r + 1, s), k = index(r + 1, s + 1),
                        l = index(r, s + 1);
      b.quad({vertex[i], vertex[j], vertex[k], vertex[l]},
             {normal[i], normal[j], normal[k], normal[l]});
    }
  }
  return b.take();
}

Mesh height_field(int cells) {
  MeshBuilder b;
  AttributeLayer uv{.name = "uv",
                    .role = AttributeRole::TexCoord,
                    .interpolation = Interpolation::Linear,
                    .dimension = 2,
                    .values = {},
                    .of_corner = {}};
  std::vector<AttributeId> normal;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = double(i) / cells, y = double(j) / cells;
      b.vertex({x, y, 0.1 * std::sin(5 * x) * std::cos(4 * y)});
      normal.push_back(b.normal(
          {-0.5 * std::cos(5 * x) * std::cos(4 * y), 0.4 * std::sin(5 * x) * std::sin(4 * y), 1}));
      uv.values.insert(uv.values.end(), {float(x), float(y)});
    }
  }
  const auto corner = [&](int i, int j) { return std::uint32_t(j * (cells + 1) + i); };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const std::array<std::uint32_t, 4> c{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                           corner(i, j + 1)};
      b.quad({VertexId(c[0]), VertexId(c[1]), VertexId(c[2]), VertexId(c[3])},
             {normal[c[0]], normal[c[1]], normal[c[2]], normal[c[3]]});
      for (int k : {0, 1, 2, 0, 2, 3}) uv.of_corner.push_back(AttributeId(c[std::size_t(k)]));
    }
  }
  Mesh mesh = b.take();
  mesh.layers.push_back(std::move(uv));
  return mesh;
}

// The strip is folded along its middle line, so each middle vertex carries two values a layer, left
// and right. Once around, left has become right: no order of them fits every vertex. The normals
// must jump where the two ends meet, since orientation flips there; layer "side" runs through.
Mesh moebius_strip(int segments) {
  MeshBuilder b;
  AttributeLayer side{.name = "side",
                      .role = AttributeRole::Other,
                      .interpolation = Interpolation::Linear,
                      .dimension = 1,
                      .values = {},
                      .of_corner = {}};
  struct Line {  // across the strip: left rim, middle, right rim
    VertexId vertex[3];
    AttributeId side[4];  // left rim, middle as seen from left, from right, right rim
  };
  // The fold: the middle line is lifted along the strip's normal.
  const auto direction = [&](int s) {
    const Vec3d out = on_circle(s, segments);
    const double twist = kPi * s / segments;
    return out * std::cos(twist) + Vec3d{0, 0, std::sin(twist)};
  };
  const auto lift = [&](int s) {
    const Vec3d along = cross(Vec3d{0, 0, 1}, on_circle(s, segments));
    return normalized(cross(along, direction(s)));
  };
  std::vector<Line> lines;
  for (int s = 0; s < segments; ++s) {
    const Vec3d middle = on_circle(s, segments) * 2.0, across = direction(s) * 0.6;
    Line line;
    line.vertex[0] = b.vertex(middle - across);
    // The fold shrinks to nothing at the ends, where it changes sides.
    line.vertex[1] = b.vertex(middle + lift(s) * (0.3 * std::sin(kPi * s / segments)));
    line.vertex[2] = b.vertex(middle + across);
    for (AttributeId& id : line.side) {
      id = AttributeId(side.values.size());
      side.values.push_back(float(side.values.size() % 7) * 0.25f);
    }
    lines.push_back(line);
  }
  Line end = lines[0];
  std::swap(end.vertex[0], end.vertex[2]);
  std::swap(end.side[0], end.side[3]);
  std::swap(end.side[1], end.side[2]);
  lines.push_back(end);

  // One normal a middle vertex and half, that of the quad pair that starts there.
  for (int half = 0; half < 2; ++half) {
    std::vector<AttributeId> normal;
    for (std::size_t s = 0; s <= std::size_t(segments); ++s) {
      const Line& here = lines[s == std::size_t(segments) ? s - 1 : s];
      const Line& next = lines[s == std::size_t(segments) ? s : s + 1];
      const Vec3d a = b.position(here.vertex[half]), c = b.position(here.vertex[half + 1]);
      normal.push_back(b.normal(cross(b.position(next.vertex[half]) - a, c - a)));
    }
    for (std::size_t s = 0; s < std::size_t(segments); ++s) {
      const Line &here = lines[s], &next = lines[s + 1];
      b.quad({here.vertex[half], next.vertex[half], next.vertex[half + 1], here.vertex[half + 1]},
             {normal[s], normal[s + 1], normal[s + 1], normal[s]});
      const AttributeId around[4] = {here.side[2 * half], next.side[2 * half],
                                     next.side[2 * half + 1], here.side[2 * half + 1]};
      for (int k : {0, 1, 2, 0, 2, 3}) side.of_corner.push_back(around[k]);
    }
  }
  Mesh mesh = b.take();
  mesh.layers.push_back(std::move(side));
  return mesh;
}

}  // namespace crease
