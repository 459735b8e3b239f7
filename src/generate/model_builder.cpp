#include "generate/model_builder.h"

#include "base/assert.h"

#include <cmath>
#include <utility>

namespace crease {

namespace {

struct CoatColor {
  const char* name;
  float r, g, b;  // linear
};

constexpr CoatColor kCoats[] = {
    {"wall plaster", 0.78f, 0.74f, 0.66f},
    {"wall ochre", 0.66f, 0.43f, 0.18f},
    {"wall cream", 0.82f, 0.70f, 0.47f},
    {"wall rose", 0.66f, 0.40f, 0.32f},
    {"wall brick", 0.42f, 0.13f, 0.07f},
    {"wall concrete", 0.45f, 0.45f, 0.46f},
    {"wall sandstone", 0.60f, 0.48f, 0.33f},
    {"roof tile", 0.45f, 0.11f, 0.05f},
    {"roof brown tile", 0.24f, 0.085f, 0.05f},
    {"roof slate", 0.08f, 0.09f, 0.12f},
    {"roof copper", 0.13f, 0.38f, 0.28f},
    {"stone", 0.38f, 0.37f, 0.35f},
    {"metal", 0.20f, 0.21f, 0.23f},
    {"glass", 0.05f, 0.10f, 0.16f},
    {"wood", 0.24f, 0.12f, 0.05f},
    {"grass", 0.15f, 0.26f, 0.08f},
    {"field", 0.28f, 0.31f, 0.10f},
    {"leaves", 0.06f, 0.18f, 0.04f},
    {"asphalt", 0.16f, 0.16f, 0.17f},
    {"water", 0.07f, 0.20f, 0.27f},
};
static_assert(std::size(kCoats) == static_cast<std::size_t>(Coat::Count));

}  // namespace

Site Site::at(const Vec3d& offset, int quarter_turns) const {
  Site site{point(offset), cosine, sine};
  for (int i = 0; i < quarter_turns; ++i) {
    site = {site.origin, -site.sine, site.cosine};
  }
  return site;
}

Vec3d on_circle(double k, int n) {
  const double angle = 2 * kPi * k / n;
  return {double(std::llround(std::cos(angle) * 1e6)) / 1e6,
          double(std::llround(std::sin(angle) * 1e6)) / 1e6, 0};
}

ModelBuilder::ModelBuilder() {
  mesh_.layers.push_back({.name = "normal",
                          .role = AttributeRole::Normal,
                          .interpolation = Interpolation::Direction,
                          .dimension = 3,
                          .values = {},
                          .of_corner = {}});
  for (const CoatColor& coat : kCoats) {
    mesh_.materials.push_back(
        {.name = coat.name, .base_color = {coat.r, coat.g, coat.b, 1}, .base_color_texture = ""});
  }
}

void ModelBuilder::begin_part(std::string name) {
  mesh_.parts.push_back(std::move(name));
}

std::size_t ModelBuilder::Hash::operator()(const Millimetres& p) const {
  std::uint64_t h = std::uint64_t(p.x) * 0x9e3779b97f4a7c15u;
  h = (h ^ (h >> 32) ^ std::uint64_t(p.y)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 32) ^ std::uint64_t(p.z)) * 0x94d049bb133111ebu;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

AttributeId ModelBuilder::normal(const Vec3d& direction) {
  return placed_normal(site_.direction(direction));
}

AttributeId ModelBuilder::placed_normal(const Vec3d& direction) {
  const Vec3d n = normalized(direction);
  AttributeLayer& layer = mesh_.layers[0];
  for (int i = 0; i < 3; ++i) layer.values.push_back(static_cast<float>(n[i]));
  return AttributeId(layer.value_count() - 1);
}

VertexId ModelBuilder::vertex(const Vec3d& p) {
  const Vec3d placed = site_.point(p);
  const Millimetres key{std::llround(placed.x * 1000), std::llround(placed.y * 1000),
                        std::llround(placed.z * 1000)};
  const auto [found, is_new] = vertex_at_.try_emplace(key, VertexId(mesh_.vertex_count()));
  if (is_new) {
    mesh_.positions.push_back({double(key.x) / 1000, double(key.y) / 1000, double(key.z) / 1000});
  }
  return found->second;
}

void ModelBuilder::triangle(const std::array<VertexId, 3>& v, const std::array<AttributeId, 3>& n) {
  if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return;
  mesh_.triangles.push_back(v);
  mesh_.material_of_triangle.push_back(coat_);
  mesh_.part_of_triangle.push_back(PartId(mesh_.parts.size() - 1));
  std::vector<AttributeId>& of_corner = mesh_.layers[0].of_corner;
  of_corner.insert(of_corner.end(), n.begin(), n.end());
}

void ModelBuilder::quad(const std::array<Vec3d, 4>& p, AttributeId n) {
  std::array<VertexId, 4> v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = vertex(p[i]);
  triangle({v[0], v[1], v[2]}, {n, n, n});
  triangle({v[0], v[2], v[3]}, {n, n, n});
}

void ModelBuilder::flat_quad(const std::array<Vec3d, 4>& p) {
  std::array<Vec3d, 4> at;  // one after the other: in the arguments of a call their order is open
  for (const std::size_t i : {1, 3, 0, 2}) at[i] = mesh_.positions[index_of(vertex(p[i]))];
  quad(p, placed_normal(cross(at[2] - at[0], at[3] - at[1])));
}

void ModelBuilder::patch(int columns, int rows, AttributeId n, const PointOf& point) {
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      quad({point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)}, n);
    }
  }
}

ModelBuilder::RimNormals ModelBuilder::smooth_patch(int columns, int rows, const PointOf& point,
                                                    const PointOf& normal_of) {
  const auto index = [&](int i, int j) { return std::size_t(j * (columns + 1) + i); };
  std::vector<VertexId> v;
  std::vector<AttributeId> n;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      v.push_back(vertex(point(i, j)));
      // A column that comes back to where the first one is uses its normals again, and a row that
      // shrinks to a point has one.
      const bool first_again = i == columns && v.back() == v[index(0, j)];
      const bool same_point = i > 0 && v.back() == v[index(i - 1, j)];
      n.push_back(first_again ? n[index(0, j)] : same_point ? n.back() : normal(normal_of(i, j)));
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::size_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1),
                        d = index(i, j + 1);
      triangle({v[a], v[b], v[c]}, {n[a], n[b], n[c]});
      triangle({v[a], v[c], v[d]}, {n[a], n[c], n[d]});
    }
  }
  return {{n.begin(), n.begin() + columns + 1}, {n.end() - (columns + 1), n.end()}};
}

void ModelBuilder::polygon(std::span<const Vec3d> loop, const Vec3d& facing) {
  const AttributeId n = normal(facing);
  std::vector<Vec3d> rest(loop.begin(), loop.end());
  // Twice the area, seen from outside. Coordinates are multiples of 5 mm: what is not above 1e-6 is
  // a line.
  const auto turn = [&](const Vec3d& p, const Vec3d& q, const Vec3d& r) {
    return dot(cross(q - p, r - p), facing);
  };
  const auto is_ear = [&](std::size_t i) {
    const std::size_t count = rest.size();
    const Vec3d &p = rest[(i + count - 1) % count], &q = rest[i], &r = rest[(i + 1) % count];
    if (turn(p, q, r) <= 1e-6) return false;
    for (const Vec3d& other : rest) {
      if (other == p || other == q || other == r) continue;
      if (turn(p, q, other) > -1e-6 && turn(q, r, other) > -1e-6 && turn(r, p, other) > -1e-6) {
        return false;
      }
    }
    return true;
  };
  while (rest.size() >= 3) {
    const std::size_t count = rest.size();
    std::size_t best = count;
    double best_length = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double diagonal = length(rest[(i + 1) % count] - rest[(i + count - 1) % count]);
      if ((best < count && diagonal >= best_length) || !is_ear(i)) continue;
      best = i;
      best_length = diagonal;
    }
    CREASE_ASSERT(best < count);
    triangle({vertex(rest[(best + count - 1) % count]), vertex(rest[best]),
              vertex(rest[(best + 1) % count])},
             {n, n, n});
    rest.erase(rest.begin() + std::ptrdiff_t(best));
  }
}

void ModelBuilder::fan(std::span<const Vec3d> loop, const Vec3d& centre, const Vec3d& facing) {
  const AttributeId n = normal(facing);
  const VertexId middle = vertex(centre);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const VertexId v = vertex(loop[i]), w = vertex(loop[(i + 1) % loop.size()]);
    triangle({middle, v, w}, {n, n, n});
  }
}

ModelBuilder::Mark ModelBuilder::mark() const {
  return {mesh_.positions.size(), mesh_.triangles.size(), mesh_.layers[0].values.size(),
          mesh_.parts.size()};
}

void ModelBuilder::take_back(const Mark& mark) {
  mesh_.positions.resize(mark.positions);
  mesh_.triangles.resize(mark.triangles);
  mesh_.material_of_triangle.resize(mark.triangles);
  mesh_.part_of_triangle.resize(mark.triangles);
  mesh_.layers[0].of_corner.resize(3 * mark.triangles);
  mesh_.layers[0].values.resize(mark.normal_values);
  mesh_.parts.resize(mark.parts);
  vertex_at_.clear();
}

}  // namespace crease
