#include "crease/import_arrays.h"

#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace crease {
namespace {

// As engines have them: one a corner, and things between that are nobody's business.
struct Vertex {
  std::uint8_t bones[5];
  float position[3], normal[3];
  std::uint16_t more;
};
#pragma pack(push, 1)
struct PackedVertex {
  std::uint8_t bone;
  double position[3];
};
#pragma pack(pop)

std::array<float, 3> floats(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Mesh mesh_of(const VertexArrays& arrays, const ImportOptions& options = {}) {
  Result<Imported> in = import_arrays(arrays, "arrays", options);
  REQUIRE_MESSAGE(in.ok(), in.failure().message);
  CHECK(check_mesh(in->mesh).ok());
  return std::move(in->mesh);
}

std::string refusal(const VertexArrays& arrays) {
  Result<Imported> in = import_arrays(arrays, "part 17", {});
  REQUIRE(!in.ok());
  return in.failure().message;
}

template <typename Number>
VertexArrays positions_of(const std::vector<Number>& numbers) {
  VertexArrays arrays;
  arrays.positions = Rows<Number>{numbers.data(), numbers.size() / 3};
  return arrays;
}

const std::vector<float> kUnitSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<std::uint32_t> kTwoTriangles = {0, 1, 2, 0, 2, 3};

VertexArrays square() {
  VertexArrays arrays = positions_of(kUnitSquare);
  arrays.indices = kTwoTriangles;
  return arrays;
}

TEST_CASE("vertices that an engine has split become one again, and hard edges stay") {
  for (const PolygonModel& model : polygon_models()) {
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    for (const PolygonModel::Face& face : model.faces) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (std::size_t i = 0; i < face.corners.size(); ++i) {
        Vertex vertex{};
        const auto p = floats(model.positions[face.corners[i]]);
        const auto n = floats(model.normals[face.normals[i]]);
        for (int k = 0; k < 3; ++k) vertex.position[k] = p[k], vertex.normal[k] = n[k];
        vertices.push_back(vertex);
        const auto at = static_cast<std::uint32_t>(i);
        if (at >= 2) indices.insert(indices.end(), {first, first + at - 1, first + at});
      }
    }
    VertexArrays arrays;
    arrays.positions = Rows<float>{vertices[0].position, vertices.size(), sizeof(Vertex)};
    arrays.indices = indices;
    arrays.layers.push_back({.name = "normal",
                             .role = AttributeRole::Normal,
                             .dimension = 3,
                             .values = {vertices[0].normal, vertices.size(), sizeof(Vertex)}});
    const Mesh mesh = mesh_of(arrays);
    CAPTURE(model.name);
    CHECK(mesh.vertex_count() == model.positions.size());
    CHECK(hard_edges(mesh) == hard_edges(model));
  }
}

TEST_CASE("values with indices of their own, as OBJ has them") {
  for (const PolygonModel& model : polygon_models()) {
    std::vector<double> positions;
    for (const Vec3d& p : model.positions) positions.insert(positions.end(), {p.x, p.y, p.z});
    std::vector<float> normals;
    for (const Vec3d& n : model.normals) {
      for (float x : floats(n)) normals.push_back(x);
    }
    std::vector<std::uint32_t> indices, of_corner;
    for (const PolygonModel::Face& face : model.faces) {
      for (std::size_t i = 2; i < face.corners.size(); ++i) {
        for (std::size_t c : {std::size_t(0), i - 1, i}) {
          indices.push_back(face.corners[c]);
          of_corner.push_back(face.normals[c]);
        }
      }
    }
    VertexArrays arrays = positions_of(positions);
    arrays.indices = indices;
    arrays.layers.push_back({.name = "normal",
                             .role = AttributeRole::Normal,
                             .dimension = 3,
                             .values = {normals.data(), model.normals.size()},
                             .of_corner = of_corner});
    const Mesh mesh = mesh_of(arrays);
    CHECK(hard_edges(mesh) == hard_edges(model));
    CHECK(mesh.normals()->value_count() == model.normals.size());
  }
}

TEST_CASE("triangles without indices, in unaligned doubles far from the origin") {
  std::vector<PackedVertex> corners;
  for (std::uint32_t v : kTwoTriangles) {
    PackedVertex corner{};
    const double position[] = {1e6 + 1e-7 * kUnitSquare[3 * v], kUnitSquare[3 * v + 1], 0};
    std::copy(position, position + 3, corner.position);
    corners.push_back(corner);
  }
  VertexArrays arrays;
  arrays.positions = Rows<double>{reinterpret_cast<const double*>(&corners[0].bone + 1),
                                  corners.size(), sizeof(PackedVertex)};
  const Mesh mesh = mesh_of(arrays);
  CHECK(mesh.triangle_count() == 2);
  REQUIRE(mesh.vertex_count() == 4);
  CHECK(mesh.positions[1].x == 1e6 + 1e-7);
}

TEST_CASE("normals are made where there are none, and at corners that lack one") {
  const std::vector<float> corner = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 1};
  const std::vector<std::uint32_t> indices = {0, 1, 2, 1, 0, 3};  // 90 degrees
  VertexArrays arrays = positions_of(corner);
  arrays.indices = indices;
  CHECK(mesh_of(arrays).normals()->value_count() == 2);
  CHECK(mesh_of(arrays, {.normals = {NormalPolicy::Kind::Smooth}}).normals()->value_count() == 4);
  arrays.made_normals = {NormalPolicy::Kind::Crease, 120};
  CHECK(mesh_of(arrays).normals()->value_count() == 4);

  const std::vector<float> up = {0, 0, 1};
  const std::vector<std::uint32_t> of_corner = {0, 0, 0, kNone, kNone, kNone};
  arrays.made_normals = {NormalPolicy::Kind::Flat};
  arrays.layers.push_back({.name = "normal",
                           .role = AttributeRole::Normal,
                           .dimension = 3,
                           .values = {up.data(), 1},
                           .of_corner = of_corner});
  CHECK(mesh_of(arrays).normals()->value_count() == 2);
}

TEST_CASE("materials, parts, texture coordinates and other numbers come along") {
  const std::vector<float> uv = {0, 0, 1, 0, 1, 1, 0, 1}, ids = {7, 7, 9, 9};
  const std::vector<std::uint32_t> materials = {1, 0}, parts = {0, 1};
  VertexArrays arrays = square();
  arrays.layers = {
      {.name = "uv", .role = AttributeRole::TexCoord, .dimension = 2, .values = {uv.data(), 4}},
      {.name = "id", .interpolation = Interpolation::Categorical, .values = {ids.data(), 4}}};
  arrays.materials = {{.name = "brick"}, {.name = "glass"}};
  arrays.parts = {"wall", "pane"};
  Mesh mesh = mesh_of(arrays);
  CHECK(mesh.material_of_triangle == std::vector<MaterialId>(2, MaterialId{0}));

  arrays.material_of_triangle = materials;
  arrays.part_of_triangle = parts;
  mesh = mesh_of(arrays);
  REQUIRE(mesh.layers.size() == 3);
  CHECK(mesh.layers[0].role == AttributeRole::Normal);
  CHECK(mesh.layers[1].value_count() == 4);
  CHECK(mesh.layers[2].value_count() == 2);
  CHECK(mesh.layers[2].interpolation == Interpolation::Categorical);
  CHECK(mesh.materials.at(index_of(mesh.material_of_triangle[0])).name == "glass");
  CHECK(mesh.parts.at(index_of(mesh.part_of_triangle[1])) == "pane");
}

TEST_CASE("short indices and bytes are widened") {
  const std::vector<std::uint16_t> short_indices(kTwoTriangles.begin(), kTwoTriangles.end());
  const std::vector<std::uint8_t> colors = {255, 0, 0, 9, 0, 51, 0, 9, 0, 0, 102, 9, 1, 2, 3, 9};
  VertexArrays arrays = square();
  arrays.indices = {};
  arrays.short_indices = short_indices;
  arrays.layers.push_back({.name = "color",
                           .role = AttributeRole::Color,
                           .dimension = 3,
                           .bytes = {colors.data(), 4, 4}});
  const Mesh mesh = mesh_of(arrays);
  CHECK(mesh.triangles == mesh_of(square()).triangles);
  const AttributeLayer& layer = mesh.layers.back();
  REQUIRE(layer.value_count() == 4);
  for (std::size_t c = 0; c < 6; ++c) {
    const std::size_t v = index_of(mesh.triangles[c / 3][c % 3]);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(layer.value(layer.of_corner[c])[k] == float(colors[4 * v + k]) / 255);
    }
  }

  arrays.indices = kTwoTriangles;
  CHECK(refusal(arrays) == "part 17: both indices and short_indices");
  arrays.indices = {};
  const std::vector<float> values(12);
  arrays.layers[0].values = {values.data(), 4};
  CHECK(refusal(arrays) == "part 17: layer 'color' has both values and bytes");
}

TEST_CASE("arrays that do not fit together are refused, by name and place") {
  const std::vector<std::uint32_t> beyond = {0, 1, 2, 0, 4, 3}, one = {0}, far = {0, 1};
  const std::vector<float> three = {0, 0, 0};
  VertexArrays arrays = square();
  arrays.indices = beyond;
  CHECK(refusal(arrays) == "part 17: indices[4] is 4, and there are 4");
  arrays.indices = std::span(beyond).first(4);
  CHECK(refusal(arrays) == "part 17: indices are three a triangle, and 4 are given");
  arrays.indices = {};
  CHECK(refusal(arrays) ==
        "part 17: positions, without indices, are three a triangle, and 4 are given");

  arrays = square();
  arrays.layers.push_back({.name = "uv", .dimension = 3, .values = {three.data(), 1}});
  CHECK(refusal(arrays) == "part 17: layer 'uv' has 1 entries, not one for each of 4 vertices");
  arrays.layers[0].of_corner = one;
  CHECK(refusal(arrays) ==
        "part 17: layer 'uv', of_corner has 1 entries, not one for each of 6 corners");
  arrays.layers[0].of_corner = kTwoTriangles;
  CHECK(refusal(arrays) == "part 17: layer 'uv', of_corner[1] is 1, and there are 1");
  arrays.layers[0].role = AttributeRole::TexCoord;
  CHECK(refusal(arrays) == "part 17: layer 'uv' has dimension 3, which its role does not allow");

  arrays = square();
  arrays.materials = {{.name = "brick"}};
  arrays.material_of_triangle = one;
  CHECK(refusal(arrays) ==
        "part 17: material_of_triangle has 1 entries, not one for each of 2 triangles");
  arrays.material_of_triangle = far;
  CHECK(refusal(arrays) == "part 17: material_of_triangle[1] is 1, and there are 1");

  arrays = square();
  arrays.materials = {{.name = "brick", .base_color = {1, NAN, 1, 1}}};
  CHECK(refusal(arrays) == "part 17: material 'brick' has a number that is not finite");
  arrays = square();
  arrays.images = {{"brick.png", nullptr}};
  CHECK(refusal(arrays) == "part 17: image 'brick.png' has no bytes");
  arrays = square();
  arrays.positions = Rows<float>{nullptr, 4};
  CHECK(refusal(arrays) == "part 17: positions are nowhere: a null pointer");
  arrays = square();
  arrays.positions = Rows<float>{kUnitSquare.data(), 4, 8};
  CHECK(refusal(arrays) == "part 17: positions overlap: rows of 12 bytes, each 8 after the last");

  arrays = VertexArrays{};
  CHECK(refusal(arrays) == "part 17: no triangles in it");
  std::vector<float> bad = kUnitSquare;
  bad[4] = std::numeric_limits<float>::infinity();
  arrays = positions_of(bad);
  arrays.indices = kTwoTriangles;
  CHECK(refusal(arrays).starts_with("part 17: positions[1] is "));
}

}  // namespace
}  // namespace crease
