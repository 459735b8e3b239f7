#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace crease {

namespace {

// GCC 12.2 at -O2 leaves the rounding out of double(float(x)) here (sincos inlined); volatile keeps
// it.
double as_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}
Vec3d as_floats(Vec3d v) {
  return {as_float(v.x), as_float(v.y), as_float(v.z)};
}

using Edge = std::pair<Point, Point>;
Point point(const Vec3d& p) {
  return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
}
Edge edge(const Vec3d& a, const Vec3d& b) {
  return point(a) < point(b) ? Edge{point(a), point(b)} : Edge{point(b), point(a)};
}

// Each edge with the normals that its ends have on each side.
class HardEdgeFinder {
 public:
  void add(const Vec3d& a, const Vec3d& b, std::uint32_t normal_a, std::uint32_t normal_b) {
    const bool swaps = point(b) < point(a);
    const std::pair<std::uint32_t, std::uint32_t> ends{swaps ? normal_b : normal_a,
                                                       swaps ? normal_a : normal_b};
    sides_[edge(a, b)].insert(ends);
  }
  HardEdges hard() const {
    HardEdges out;
    for (const auto& [e, ends] : sides_) {
      if (ends.size() > 1) out.insert(e);
    }
    return out;
  }

 private:
  std::map<Edge, std::set<std::pair<std::uint32_t, std::uint32_t>>> sides_;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> PolygonModel::triangles() const {
  std::vector<std::array<std::uint32_t, 3>> out;
  for (const Face& face : faces) {
    for (std::size_t i = 2; i < face.corners.size(); ++i) {
      out.push_back({face.corners[0], face.corners[i - 1], face.corners[i]});
    }
  }
  return out;
}

PolygonModel polygon_cube() {
  PolygonModel cube{
      .name = "cube", .positions = {}, .faces = {}, .normals = {}, .hard_edge_count = 12};
  for (int i = 0; i < 8; ++i)
    cube.positions.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  const std::vector<std::vector<std::uint32_t>> sides{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                      {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  cube.normals = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
  for (std::uint32_t s = 0; s < 6; ++s) cube.faces.push_back({sides[s], {s, s, s, s}, s + 1});
  return cube;
}

PolygonModel polygon_cylinder() {
  constexpr std::uint32_t kSegments = 24;
  PolygonModel cylinder{.name = "cylinder",
                        .positions = {},
                        .faces = {},
                        .normals = {},
                        .hard_edge_count = 2 * kSegments};
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const double angle = 2 * kPi * i / kSegments;
    const Vec3d around = as_floats({std::cos(angle), std::sin(angle), 0});
    cylinder.positions.push_back(around);
    cylinder.positions.push_back({around.x, around.y, 2});
    cylinder.normals.push_back(around);
  }
  cylinder.normals.push_back({0, 0, -1});
  cylinder.normals.push_back({0, 0, 1});
  PolygonModel::Face bottom{{}, std::vector<std::uint32_t>(kSegments, kSegments), 2};
  PolygonModel::Face top{{}, std::vector<std::uint32_t>(kSegments, kSegments + 1), 3};
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const std::uint32_t j = (i + 1) % kSegments;
    cylinder.faces.push_back({{2 * i, 2 * j, 2 * j + 1, 2 * i + 1}, {i, j, j, i}, 1});
    bottom.corners.push_back(2 * (kSegments - 1 - i));
    top.corners.push_back(2 * i + 1);
  }
  cylinder.faces.push_back(bottom);
  cylinder.faces.push_back(top);
  return cylinder;
}

std::vector<PolygonModel> polygon_models() {
  return {polygon_cube(), polygon_cylinder()};
}

HardEdges hard_edges(const Mesh& mesh) {
  HardEdgeFinder finder;
  const AttributeLayer* normals = mesh.normals();
  REQUIRE(normals != nullptr);
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
    const auto position = [&](std::size_t c) {
      return mesh.positions[index_of(mesh.triangles[c / 3][c % 3])];
    };
    const auto normal = [&](std::size_t c) {
      return static_cast<std::uint32_t>(index_of(normals->of_corner[c]));
    };
    finder.add(position(corner), position(next), normal(corner), normal(next));
  }
  return finder.hard();
}

HardEdges hard_edges(const PolygonModel& model) {
  HardEdgeFinder finder;
  for (const PolygonModel::Face& face : model.faces) {
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const std::size_t j = (i + 1) % face.corners.size();
      finder.add(model.positions[face.corners[i]], model.positions[face.corners[j]],
                 face.normals[i], face.normals[j]);
    }
  }
  return finder.hard();
}

Imported import_text(std::string_view text, std::string_view name, const ImportOptions& options) {
  Result<Imported> got = import_bytes(std::as_bytes(std::span(text)), name, options);
  const std::string message = got.ok() ? std::string() : got.failure().message;
  REQUIRE_MESSAGE(got.ok(), message);
  CHECK(check_mesh(got->mesh).ok());
  REQUIRE(!got->mesh.layers.empty());
  CHECK(got->mesh.layers[0].role == AttributeRole::Normal);
  return std::move(*got);
}

std::string refusal_of(std::string_view text, std::string_view name) {
  const Result<Imported> got = import_bytes(std::as_bytes(std::span(text)), name, {});
  REQUIRE(!got.ok());
  return got.failure().message;
}

}  // namespace crease
