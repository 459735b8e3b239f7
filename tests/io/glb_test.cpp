// GLB out and in again. That the files are valid glTF is gltf-validator's to say
// (tests/validators).
#include "crease/export.h"
#include "crease/import.h"
#include "crease/shading.h"
#include "io/gltf_sample.h"
#include "io/polygon_model.h"
#include "support/mesh_zoo.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace crease {
namespace {

Mesh read(const std::vector<std::byte>& bytes) {
  Result<Imported> in = import_bytes(bytes, "written.glb", {});
  REQUIRE_MESSAGE(in.ok(), (in.ok() ? "" : in.failure().message));
  return std::move(in->mesh);
}

Mesh there_and_back(const Mesh& mesh) {
  const Result<std::vector<std::byte>> bytes = export_bytes(mesh, ".glb");
  REQUIRE_MESSAGE(bytes.ok(), (bytes.ok() ? "" : bytes.failure().message));
  return read(*bytes);
}

nlohmann::json json_of(const std::vector<std::byte>& bytes) {
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  const auto* text = reinterpret_cast<const char*>(bytes.data() + 20);
  return nlohmann::json::parse(text, text + length, nullptr, false);
}

const AttributeLayer& required_layer(const Mesh& mesh, const std::string& name) {
  const auto found = std::ranges::find(mesh.layers, name, &AttributeLayer::name);
  REQUIRE(found != mesh.layers.end());
  return *found;
}

double largest_difference(const AttributeLayer& a, const AttributeLayer& b) {
  double largest = 0;
  for (std::size_t corner = 0; corner < a.of_corner.size(); ++corner) {
    const auto x = a.value(a.of_corner[corner]), y = b.value(b.of_corner[corner]);
    for (std::size_t k = 0; k < x.size(); ++k) {
      largest = std::max(largest, std::abs(double(x[k]) - double(y[k])));
    }
  }
  return largest;
}

double largest_move(const Mesh& a, const Mesh& b) {
  double largest = 0;
  for (std::size_t t = 0; t < a.triangle_count(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, length(a.positions[index_of(a.triangles[t][c])] -
                                         b.positions[index_of(b.triangles[t][c])]));
    }
  }
  return largest;
}

// Triangles whose corners stay apart when positions are welded.
std::size_t without_equal_points(const Mesh& mesh) {
  return static_cast<std::size_t>(std::ranges::count_if(mesh.triangles, [&](const Triangle& t) {
    const auto at = [&](std::size_t c) { return mesh.positions[index_of(t[c])]; };
    return at(0) != at(1) && at(1) != at(2) && at(2) != at(0);
  }));
}

// Used vertices and values only, bit-equal ones as one: what a format of split vertices can hold.
std::size_t distinct_values(const AttributeLayer& layer) {
  std::set<std::vector<float>> values;
  for (AttributeId a : layer.of_corner) {
    const auto value = layer.value(a);
    values.insert({value.begin(), value.end()});
  }
  return values.size();
}

}  // namespace

TEST_CASE("GLB has y up, but for what is written here with z up") {
  Mesh mesh = cone(8, 2);
  for (const UpAxis up : {UpAxis::Unknown, UpAxis::Y, UpAxis::Z}) {
    mesh.up = up;
    const Mesh back = there_and_back(mesh);
    CHECK(back.up == (up == UpAxis::Z ? UpAxis::Z : UpAxis::Y));
    CHECK(largest_move(mesh, back) < 1e-6);
  }
}

TEST_CASE("GLB: every zoo mesh comes back triangle for triangle") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangles.empty() || !z.mesh.part_of_triangle.empty() ||
        !z.mesh.material_of_triangle.empty()) {
      continue;  // those are put in another order
    }
    CAPTURE(z.name);
    const Mesh back = there_and_back(z.mesh);
    REQUIRE(back.triangle_count() == without_equal_points(z.mesh));
    if (back.triangle_count() != z.mesh.triangle_count()) continue;
    CHECK(largest_move(z.mesh, back) < 1e-5);
    REQUIRE(back.layers.size() == z.mesh.layers.size());
    for (std::size_t l = 0; l < back.layers.size(); ++l) {
      CAPTURE(z.mesh.layers[l].name);
      CHECK(largest_difference(z.mesh.layers[l], back.layers[l]) < 1e-6);
      CHECK(back.layers[l].value_count() == distinct_values(z.mesh.layers[l]));
    }
    // A second time nothing changes at all.
    const Mesh again = there_and_back(back);
    CHECK(again.positions == back.positions);
    CHECK(again.triangles == back.triangles);
    for (std::size_t l = 0; l < back.layers.size(); ++l) {
      CHECK(again.layers[l].of_corner == back.layers[l].of_corner);
    }
  }
}

TEST_CASE("GLB: hard edges survive") {
  for (const Mesh& mesh : {hard_box(3), hard_cylinder(16, 4), gear(7), bevelled_box()}) {
    const Mesh first = there_and_back(mesh);
    CHECK(hard_edges(first).size() == hard_edges(mesh).size());
    const ShadingKinds before = classify_shading(mesh), after = classify_shading(first);
    CHECK(std::ranges::count(before.of_vertex, VertexKind::SN) ==
          std::ranges::count(after.of_vertex, VertexKind::SN));
    CHECK(before.of_triangle == after.of_triangle);
  }
}

TEST_CASE("GLB: texture coordinates, colours, own layers, materials and parts come back") {
  const Mesh mesh = everything_mesh();
  const Mesh back = there_and_back(mesh);
  REQUIRE(back.triangle_count() == mesh.triangle_count());
  CHECK(back.materials == mesh.materials);
  CHECK(back.parts == mesh.parts);
  CHECK(back.vertex_count() == mesh.vertex_count());
  // Triangles are ordered by part, then by material; so is a copy of the input.
  std::vector<std::size_t> order(mesh.triangle_count());
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
  std::ranges::stable_sort(order, {}, [&](std::size_t t) {
    return std::pair(mesh.part_of_triangle[t], mesh.material_of_triangle[t]);
  });
  Mesh sorted = mesh;
  for (std::size_t t = 0; t < order.size(); ++t) {
    sorted.triangles[t] = mesh.triangles[order[t]];
    sorted.part_of_triangle[t] = mesh.part_of_triangle[order[t]];
    sorted.material_of_triangle[t] = mesh.material_of_triangle[order[t]];
    for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
      for (std::size_t c = 0; c < 3; ++c) {
        sorted.layers[l].of_corner[3 * t + c] = mesh.layers[l].of_corner[3 * order[t] + c];
      }
    }
  }
  CHECK(back.part_of_triangle == sorted.part_of_triangle);
  CHECK(back.material_of_triangle == sorted.material_of_triangle);
  CHECK(largest_move(sorted, back) == 0);  // halves and quarters around the middle are floats
  for (const char* name : {"normal", "uv", "color", "wind"}) {
    CAPTURE(name);
    CHECK(largest_difference(required_layer(sorted, name), required_layer(back, name)) < 1e-7);
  }
  CHECK(largest_difference(required_layer(sorted, "semantic surface"),
                           required_layer(back, "semantic_surface")) == 0);
}

TEST_CASE("GLB: colours are linear there, and bytes come back") {
  Mesh mesh = faceted_sphere(12, 16);
  AttributeLayer colors{"color", AttributeRole::Color, Interpolation::Linear, 4, {}, {}};
  for (int k = 0; k < 256; ++k) {
    const float byte = float(k) / 255;
    colors.values.insert(colors.values.end(), {byte, 1 - byte, 0.5f, byte});
  }
  for (std::size_t c = 0; c < 3 * mesh.triangle_count(); ++c) {
    colors.of_corner.push_back(AttributeId{static_cast<std::uint32_t>(c % 256)});
  }
  mesh.layers.push_back(colors);
  const auto bytes = export_bytes(mesh, ".glb");
  REQUIRE(bytes.ok());
  const auto json = json_of(*bytes);
  const std::size_t accessor = json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"];
  const std::size_t view = json["accessors"][accessor]["bufferView"];
  const std::size_t begin = json["bufferViews"][view]["byteOffset"];
  const std::size_t json_bytes =
      std::size_t((*bytes)[12]) | std::size_t((*bytes)[13]) << 8 | std::size_t((*bytes)[14]) << 16;
  float first[4];
  std::memcpy(first, bytes->data() + 28 + json_bytes + begin, sizeof first);
  CHECK(first[2] == doctest::Approx(0.214041));  // a half, as light
  const Mesh back = there_and_back(mesh);
  CHECK(largest_difference(colors, required_layer(back, "color")) < 1e-6);
}

TEST_CASE("GLB: city coordinates lose less than a ten-thousandth of a millimetre per metre") {
  Mesh mesh = faceted_sphere(12, 16);
  for (Vec3d& p : mesh.positions) p += Vec3d{389'000.123456, 5'819'000.654321, 34.5};
  const Mesh back = there_and_back(mesh);
  CHECK(largest_move(mesh, back) < 1e-7);
}

TEST_CASE("GLB: indices are as wide as they must be, restart is never one") {
  const auto index_types = [](const Mesh& mesh) {
    const auto bytes = export_bytes(mesh, ".glb");
    REQUIRE(bytes.ok());
    const auto json = json_of(*bytes);
    const std::size_t accessor = json["meshes"][0]["primitives"][0]["indices"];
    return json["accessors"][accessor]["componentType"].get<int>();
  };
  CHECK(index_types(hard_box(1)) == 5123);
  const Mesh large = faceted_sphere(120, 200);
  CHECK(index_types(large) == 5125);
  CHECK(there_and_back(large).triangle_count() == large.triangle_count());
}

TEST_CASE("GLB: a mesh without normals is written flat, one without triangles is refused") {
  Mesh bare = hard_box(1);
  bare.layers.clear();
  const Mesh back = there_and_back(bare);
  REQUIRE(back.normals() != nullptr);
  CHECK(hard_edges(back).size() == 12);
  CHECK_FALSE(export_bytes(Mesh{}, ".glb").ok());
}

TEST_CASE("GLB: levels of detail stand beside each other as MSFT_lod says") {
  const std::vector<Mesh> levels = {smooth_sphere(24, 32), smooth_sphere(12, 16),
                                    smooth_sphere(6, 8)};
  const std::vector<double> coverage = {0.5, 0.25, 0.01};
  const auto bytes = export_lod_glb(levels, coverage);
  REQUIRE(bytes.ok());
  const auto json = json_of(*bytes);
  REQUIRE(json["scenes"][0]["nodes"].size() == 1);
  const std::size_t root = json["scenes"][0]["nodes"][0];
  CHECK(json["extensionsUsed"] == nlohmann::json{"MSFT_lod"});
  const auto& ids = json["nodes"][root]["extensions"]["MSFT_lod"]["ids"];
  REQUIRE(ids.size() == 2);
  CHECK(json["nodes"][root]["extras"]["MSFT_screencoverage"] == nlohmann::json(coverage));
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t mesh = json["nodes"][ids[i].get<std::size_t>()]["mesh"];
    const std::size_t indices = json["meshes"][mesh]["primitives"][0]["indices"];
    CHECK(json["accessors"][indices]["count"] == 3 * levels[i + 1].triangle_count());
  }
  CHECK(read(*bytes).triangle_count() == levels[0].triangle_count());  // a reader sees the finest
  CHECK_FALSE(export_lod_glb(levels, std::vector<double>{0.5}).ok());
  CHECK_FALSE(export_lod_glb({}, {}).ok());
}

TEST_CASE("GLB: real models come back with the same hard edges and values") {
  for (const char* name : {"attributes/lantern.glb", "attributes/corset.glb",
                           "attributes/cow_viewpoint.obj.zst", "cad/hoppe_cessna.obj.zst"}) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty()) continue;
    CAPTURE(name);
    const Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    const Mesh first = there_and_back(in->mesh);
    CHECK(first.triangle_count() == in->mesh.triangle_count());
    CHECK(first.vertex_count() == in->mesh.vertex_count());
    CHECK(hard_edges(first).size() == hard_edges(in->mesh).size());
    const Mesh second = there_and_back(first);
    CHECK(second.positions == first.positions);
    CHECK(second.triangles == first.triangles);
    CHECK(second.normals()->of_corner == first.normals()->of_corner);
  }
}

}  // namespace crease
