#include "crease/import.h"
#include "crease/shading.h"
#include "io/gltf_builder.h"
#include "io/polygon_model.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace crease {
namespace {

using Json = GltfBuilder::Json;

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

// One triangle in the plane z = 0, facing +z, in one node.
GltfBuilder one_triangle() {
  GltfBuilder b;
  b.primitive({{"POSITION", b.add(kTriangle, "VEC3")}});
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

Vec3d corner(const Mesh& mesh, std::size_t t, std::size_t c) {
  return mesh.positions[index_of(mesh.triangles[t][c])];
}

std::vector<float> value_at(const Mesh& mesh, const std::string& layer, std::size_t t,
                            std::size_t c) {
  for (const AttributeLayer& l : mesh.layers) {
    if (l.name != layer) continue;
    const auto value = l.value(l.of_corner[3 * t + c]);
    return {value.begin(), value.end()};
  }
  return {};
}

Vec3d normal_at(const Mesh& mesh, std::size_t t, std::size_t c) {
  const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + c]);
  return {n[0], n[1], n[2]};
}

Vec3d face_normal(const Mesh& mesh, std::size_t t) {
  return normalized(
      cross(corner(mesh, t, 1) - corner(mesh, t, 0), corner(mesh, t, 2) - corner(mesh, t, 0)));
}

bool has_note(const ImportReport& report, const std::string& words) {
  return std::ranges::any_of(report.notes,
                             [&](const auto& n) { return n.find(words) != std::string::npos; });
}

// Split vertices with normals, as every exporter writes them.
GltfBuilder split_model(const PolygonModel& model) {
  GltfBuilder b;
  std::vector<float> positions, normals;
  std::vector<std::uint16_t> indices;
  for (const PolygonModel::Face& face : model.faces) {
    const auto first = static_cast<std::uint16_t>(positions.size() / 3);
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        positions.push_back(static_cast<float>(model.positions[face.corners[i]][k]));
        normals.push_back(static_cast<float>(model.normals[face.normals[i]][k]));
      }
      if (i < 2) continue;
      indices.push_back(first);
      indices.push_back(static_cast<std::uint16_t>(first + i - 1));
      indices.push_back(static_cast<std::uint16_t>(first + i));
    }
  }
  b.primitive({{"POSITION", b.add(positions, "VEC3")}, {"NORMAL", b.add(normals, "VEC3")}},
              b.add(indices, "SCALAR"));
  return b;
}

}  // namespace

TEST_CASE("glTF: the cube and the cylinder keep their hard edges in every container") {
  for (const PolygonModel& model : polygon_models()) {
    CAPTURE(model.name);
    const GltfBuilder b = split_model(model);
    for (const auto& [text, name] :
         {std::pair(b.gltf(), "model.gltf"), std::pair(b.glb(), "model.glb"),
          std::pair(b.b3dm(), "model.b3dm")}) {
      CAPTURE(name);
      const Imported imported = import_text(text, name);
      CHECK(imported.mesh.vertex_count() == model.positions.size());
      CHECK(imported.mesh.triangle_count() == model.triangles().size());
      CHECK(hard_edges(imported.mesh).size() == model.hard_edge_count);
      CHECK(hard_edges(imported.mesh) == hard_edges(model));
    }
  }
}

TEST_CASE("glTF without NORMAL is flat") {
  GltfBuilder b;
  b.primitive({{"POSITION", b.add<float>({0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 0}, "VEC3")}},
              b.add<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR"));
  const Mesh mesh = import_text(b.glb(), "bent.glb").mesh;
  CHECK(mesh.triangle_count() == 2);
  CHECK(hard_edges(mesh).size() == 1);
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(dot(normal_at(mesh, t, c), face_normal(mesh, t)) > 0.999999);
    }
  }
}

TEST_CASE("glTF: transforms of nested nodes are baked in doubles") {
  GltfBuilder b = one_triangle();
  // Turn by 90 degrees about z, twice as large, then 10^6 away: (1, 0, 0) -> (0, 2, 0) -> far.
  b.json["nodes"] = {{{"mesh", 0},
                      {"rotation", {0, 0, 0.7071067811865476, 0.7071067811865476}},
                      {"scale", {2, 2, 2}},
                      {"name", "inner"}},
                     {{"children", {0}}, {"translation", {389000.123, 5819000.456, 34.5}}}};
  b.json["scenes"] = {{{"nodes", {1}}}};
  b.json["scene"] = 0;
  const Mesh mesh = import_text(b.gltf(), "moved.gltf").mesh;
  CHECK(corner(mesh, 0, 0) == Vec3d{389000.123, 5819000.456, 34.5});
  CHECK(length(corner(mesh, 0, 1) - Vec3d{389000.123, 5819002.456, 34.5}) < 1e-9);
  CHECK(length(corner(mesh, 0, 2) - Vec3d{388998.123, 5819000.456, 34.5}) < 1e-9);
  CHECK(normal_at(mesh, 0, 0).z == doctest::Approx(1));
}

TEST_CASE("glTF: a matrix is read by columns, and a mirroring one turns the winding") {
  GltfBuilder b;
  b.primitive({{"POSITION", b.add(kTriangle, "VEC3")},
               {"NORMAL", b.add<float>({0, 0, 1, 0, 0, 1, 0.6f, 0, 0.8f}, "VEC3")}});
  // x -> -2 x + 5, z -> 3 z.
  b.json["nodes"] = {{{"mesh", 0}, {"matrix", {-2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 3, 0, 5, 0, 0, 1}}}};
  const Mesh mesh = import_text(b.gltf(), "mirrored.gltf").mesh;
  CHECK(corner(mesh, 0, 0) == Vec3d{5, 0, 0});
  CHECK(face_normal(mesh, 0).z == doctest::Approx(1));
  // Corners 1 and 2 are swapped; the normal of old corner 2 by the inverse transpose.
  const Vec3d expected = normalized(Vec3d{0.6 / -2, 0, 0.8 / 3});
  CHECK(corner(mesh, 0, 1) == Vec3d{5, 1, 0});
  CHECK(dot(normal_at(mesh, 0, 1), expected) == doctest::Approx(1).epsilon(1e-6));
  CHECK(normal_at(mesh, 0, 2).z == doctest::Approx(1));
}

TEST_CASE("glTF: one mesh under several nodes is a part each time") {
  GltfBuilder b = one_triangle();
  b.json["nodes"] = {{{"mesh", 0}, {"name", "left"}},
                     {{"mesh", 0}, {"translation", {3, 0, 0}}, {"name", "right"}}};
  const Mesh mesh = import_text(b.gltf(), "twice.gltf").mesh;
  CHECK(mesh.parts == std::vector<std::string>{"left", "right"});
  CHECK(mesh.triangle_count() == 2);
  CHECK(mesh.part_of_triangle == std::vector<PartId>{PartId{0}, PartId{1}});
  CHECK(corner(mesh, 1, 0) == Vec3d{3, 0, 0});
}

GltfBuilder triangle_at_a_node() {
  GltfBuilder b;
  b.primitive({{"POSITION", b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}});
  b.json["nodes"] = {{{"mesh", 0}}};
  b.json["scenes"] = {{{"nodes", {0}}}};
  return b;
}

TEST_CASE("glTF: instances that are not taken are told") {
  GltfBuilder b = triangle_at_a_node();
  b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = 0;
  b.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  CHECK(has_note(import_text(b.gltf(), "a.gltf").report,
                 "1 nodes with EXT_mesh_gpu_instancing taken once"));
}

TEST_CASE("glTF: morph targets are taken by the mesh's weights, or the node's") {
  GltfBuilder b = triangle_at_a_node();
  const auto normals = b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const auto up = b.add<float>({0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3");
  const auto turned = b.add<float>({2, 0, 0, 2, 0, 0, 2, 0, 0}, "VEC3");
  GltfBuilder::Json& primitive = b.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = normals;
  primitive["targets"] = {{{"POSITION", up}}, {{"POSITION", up}, {"NORMAL", turned}}};
  const auto height = [&] {
    const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
    CHECK(mesh.vertex_count() == 3);
    return mesh.positions[0].z;
  };
  CHECK(height() == 0);
  b.json["meshes"][0]["weights"] = {0.5, 0.0};
  CHECK(height() == 2);
  b.json["nodes"][0]["weights"] = {0.25, 0.5};
  CHECK(height() == 3);
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(mesh.layers[0].values[0] == doctest::Approx(std::sqrt(0.5)));
  CHECK(mesh.layers[0].values[2] == doctest::Approx(std::sqrt(0.5)));

  b.json["nodes"].push_back({{"mesh", 0}, {"weights", {1.0, 0.0}}});
  b.json["scenes"][0]["nodes"] = {0, 1};
  const Mesh both = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(both.triangle_count() == 2);
  CHECK(both.positions[0].z + both.positions[3].z == 7);

  primitive["targets"][1]["POSITION"] = b.add<float>({1, 2, 3}, "VEC3");
  CHECK(refusal_of(b.gltf(), "a.gltf").find("targets[1].POSITION") != std::string::npos);
}

TEST_CASE("glTF: every index type, and none") {
  const auto check = [](const GltfBuilder& b) {
    const Mesh mesh = import_text(b.glb(), "indices.glb").mesh;
    CHECK(mesh.triangle_count() == 1);
    CHECK(corner(mesh, 0, 1) == Vec3d{1, 0, 0});
  };
  GltfBuilder none = one_triangle(), bytes = one_triangle(), shorts = one_triangle(),
              ints = one_triangle();
  const auto set = [](GltfBuilder& b, std::size_t accessor) {
    b.json["meshes"][0]["primitives"][0]["indices"] = accessor;
  };
  set(bytes, bytes.add<std::uint8_t>({0, 1, 2}, "SCALAR"));
  set(shorts, shorts.add<std::uint16_t>({0, 1, 2}, "SCALAR"));
  set(ints, ints.add<std::uint32_t>({0, 1, 2}, "SCALAR"));
  for (const GltfBuilder* b : {&none, &bytes, &shorts, &ints}) check(*b);
}

TEST_CASE("glTF: strips and fans run the way their first triangle does") {
  //   1---3---5     a strip 0 1 2 3 4 5 facing -z, a fan around 0 facing +z
  //   | \ | \ |
  //   0---2---4
  GltfBuilder strip;
  strip.primitive(
      {{"POSITION", strip.add<float>({0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0},
                                     "VEC3")}})["mode"] = 5;
  const Mesh strip_mesh = import_text(strip.glb(), "strip.glb").mesh;
  CHECK(strip_mesh.triangle_count() == 4);
  for (std::size_t t = 0; t < 4; ++t) CHECK(face_normal(strip_mesh, t).z == doctest::Approx(-1));

  GltfBuilder fan;
  fan.primitive(
      {{"POSITION", fan.add<float>({0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0}, "VEC3")}},
      fan.add<std::uint16_t>({0, 1, 2, 3, 4}, "SCALAR"))["mode"] = 6;
  const Mesh fan_mesh = import_text(fan.glb(), "fan.glb").mesh;
  CHECK(fan_mesh.triangle_count() == 3);
  for (std::size_t t = 0; t < 3; ++t) CHECK(face_normal(fan_mesh, t).z == doctest::Approx(1));
}

TEST_CASE("glTF: sparse accessors replace values, with a base and without") {
  for (const bool has_base : {true, false}) {
    GltfBuilder b;
    const std::size_t where = b.add_view<std::uint16_t>({1, 2});
    const std::size_t what = b.add_view<float>({5, 0, 0, 0, 7, 0});
    Json accessor = {{"componentType", 5126},
                     {"count", 3},
                     {"type", "VEC3"},
                     {"sparse",
                      {{"count", 2},
                       {"indices", {{"bufferView", where}, {"componentType", 5123}}},
                       {"values", {{"bufferView", what}}}}}};
    if (has_base) accessor["bufferView"] = b.add_view<float>({0, 0, 1, 9, 9, 9, 9, 9, 9});
    b.primitive({{"POSITION", b.add_accessor(accessor)}});
    const Mesh mesh = import_text(b.gltf(), "sparse.gltf").mesh;
    CHECK(corner(mesh, 0, 0) == Vec3d{0, 0, has_base ? 1.0 : 0.0});
    CHECK(corner(mesh, 0, 1) == Vec3d{5, 0, 0});
    CHECK(corner(mesh, 0, 2) == Vec3d{0, 7, 0});
  }
}

TEST_CASE("glTF: quantized attributes (KHR_mesh_quantization), interleaved") {
  GltfBuilder b;
  // A vertex of 20 bytes: position 3 shorts + 2 bytes, normal 4 bytes, uv 2 shorts, colour 4 bytes.
  std::vector<std::uint8_t> bytes;
  const auto put16 = [&](int value) {
    bytes.push_back(static_cast<std::uint8_t>(value & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(value >> 8 & 0xff));
  };
  const int positions[3][3] = {{0, 0, 0}, {32767, 0, 0}, {0, -32767, 0}};
  for (const auto& p : positions) {
    for (int x : p) put16(x);
    put16(0);
    for (int n : {0, 0, -127, 0}) bytes.push_back(static_cast<std::uint8_t>(n));
    put16(65535);
    put16(0);
    for (int c : {255, 0, 51, 255}) bytes.push_back(static_cast<std::uint8_t>(c));
  }
  const std::size_t view = b.add_view(bytes, 20);
  const auto accessor = [&](std::size_t offset, int component, const char* type) {
    return b.add_accessor({{"bufferView", view},
                           {"byteOffset", offset},
                           {"componentType", component},
                           {"count", 3},
                           {"type", type},
                           {"normalized", true}});
  };
  b.primitive({{"POSITION", accessor(0, 5122, "VEC3")},
               {"NORMAL", accessor(8, 5120, "VEC3")},
               {"TEXCOORD_0", accessor(12, 5123, "VEC2")},
               {"COLOR_0", accessor(16, 5121, "VEC4")}});
  b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Mesh mesh = import_text(b.glb(), "quantized.glb").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{1, 0, 0});
  CHECK(corner(mesh, 0, 2) == Vec3d{0, -1, 0});
  CHECK(normal_at(mesh, 0, 0) == Vec3d{0, 0, -1});
  CHECK(value_at(mesh, "uv", 0, 0) == std::vector<float>{1, 1});  // v 0 is the top: 1 with v up
  CHECK(value_at(mesh, "color", 0, 0) == std::vector<float>{1, 0, 0.2f, 1});
}

TEST_CASE("glTF: further sets and attributes of one's own are carried") {
  GltfBuilder b = one_triangle();
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = b.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  attributes["TEXCOORD_1"] = b.add<float>({0.25f, 0.5f, 0.25f, 0.5f, 0.25f, 0.5f}, "VEC2");
  attributes["_BATCHID"] = b.add<float>({4, 4, 4}, "SCALAR");
  attributes["_TEMPERATURE"] = b.add<float>({20, 21, 22}, "SCALAR");
  attributes["TANGENT"] = b.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  const Imported imported = import_text(b.gltf(), "attributes.gltf");
  const Mesh& mesh = imported.mesh;
  CHECK(value_at(mesh, "uv", 0, 2) == std::vector<float>{0, 0});
  CHECK(value_at(mesh, "uv1", 0, 0) == std::vector<float>{0.25f, 0.5f});
  CHECK(value_at(mesh, "TEMPERATURE", 0, 1) == std::vector<float>{21});
  const auto batch = std::ranges::find(mesh.layers, "BATCHID", &AttributeLayer::name);
  REQUIRE(batch != mesh.layers.end());
  CHECK(batch->interpolation == Interpolation::Categorical);
  CHECK(has_note(imported.report, "TANGENT"));
}

TEST_CASE("glTF: primitives need not have the same attributes") {
  GltfBuilder b;
  const std::vector<float> above = {0, 0, 1, 1, 0, 1, 0, 1, 1};
  b.primitive({{"POSITION", b.add(kTriangle, "VEC3")},
               {"COLOR_0", b.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3")}});
  b.primitive({{"POSITION", b.add(above, "VEC3")},
               {"NORMAL", b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")},
               {"COLOR_0", b.add<float>({0, 1, 0, 0.5f, 0, 1, 0, 0.5f, 0, 1, 0, 0.5f}, "VEC4")}});
  b.primitive({{"POSITION", b.add<float>({0, 0, 2, 0, 1, 2, 1, 0, 2}, "VEC3")}});
  const Mesh mesh = import_text(b.glb(), "mixed.glb").mesh;
  REQUIRE(mesh.triangle_count() == 3);
  CHECK(value_at(mesh, "color", 0, 0) == std::vector<float>{1, 0, 0, 1});
  CHECK(value_at(mesh, "color", 1, 0) == std::vector<float>{0, 1, 0, 0.5f});
  CHECK(value_at(mesh, "color", 2, 0) == std::vector<float>{1, 1, 1, 1});
  CHECK(normal_at(mesh, 1, 0).z == doctest::Approx(1));
  CHECK(normal_at(mesh, 2, 0).z == doctest::Approx(-1));  // its own, flat
}

TEST_CASE("glTF: base colours and texture references of materials") {
  GltfBuilder b = one_triangle();
  b.json["meshes"][0]["primitives"][0]["material"] = 1;
  b.primitive({{"POSITION", b.add<float>({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3")}});
  b.json["materials"] = {
      {{"name", "plain"}},
      {{"name", "brick"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}, {"baseColorTexture", {{"index", 0}}}}}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["images"] = {{{"uri", "brick.png"}}};
  const Mesh mesh = import_text(b.gltf(), "materials.gltf").mesh;
  REQUIRE(mesh.materials.size() == 3);
  CHECK(mesh.materials[1].name == "brick");
  CHECK(mesh.materials[1].base_color == std::array<float, 4>{0.5f, 0.25f, 0.125f, 1});
  CHECK(mesh.materials[1].base_color_texture == "brick.png");
  CHECK(mesh.material_of_triangle == std::vector<MaterialId>{MaterialId{1}, MaterialId{2}});
}

TEST_CASE("b3dm: the centre of a tile is added, turned to y-up") {
  const GltfBuilder b = one_triangle();
  const Mesh mesh =
      import_text(b.b3dm(R"({"BATCH_LENGTH":0,"RTC_CENTER":[100,200,300]})"), "t.b3dm").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{101, 300, -200});
}

TEST_CASE("glTF: what cannot be meant is refused, with its place") {
  const auto refused = [](const char* place, auto change) {
    GltfBuilder b = one_triangle();
    change(b);
    const std::string message = refusal_of(b.gltf(), "bad.gltf");
    CAPTURE(message);
    CHECK(message.starts_with("bad.gltf: "));
    CHECK(message.find(place) != std::string::npos);
  };
  refused("meshes: an object, as in glTF 1.0", [](GltfBuilder& b) {
    b.json["meshes"] = {{"named", {{"primitives", nlohmann::json::array()}}}};
  });
  refused("nodes[1]", [](GltfBuilder& b) {  // a loop below a root
    b.json["nodes"] = {{{"children", {1}}}, {{"children", {2}}}, {{"children", {1}}, {"mesh", 0}}};
  });
  refused("nodes[0].children[0]", [](GltfBuilder& b) { b.json["nodes"][0]["children"] = {7}; });
  refused("nodes[0].mesh", [](GltfBuilder& b) { b.json["nodes"][0]["mesh"] = 3; });
  refused("nodes[0].matrix", [](GltfBuilder& b) { b.json["nodes"][0]["matrix"] = {1, 2}; });
  refused("attributes.POSITION", [](GltfBuilder& b) {
    b.json["meshes"][0]["primitives"][0]["attributes"].erase("POSITION");
  });
  refused("attributes.POSITION", [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 4; });
  refused("attributes.POSITION", [](GltfBuilder& b) { b.json["accessors"][0]["type"] = "VEC2"; });
  refused("attributes.POSITION",
          [](GltfBuilder& b) { b.json["accessors"][0]["count"] = 18446744073709551615ull; });
  refused("bufferViews[0]", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteLength"] = 100; });
  refused("byteStride", [](GltfBuilder& b) { b.json["bufferViews"][0]["byteStride"] = 4; });
  refused("attributes.NORMAL", [](GltfBuilder& b) {
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = b.add<float>({0, 0, 1}, "VEC3");
  });
  refused("indices[2]", [](GltfBuilder& b) {
    b.json["meshes"][0]["primitives"][0]["indices"] = b.add<std::uint8_t>({0, 1, 3}, "SCALAR");
  });
  refused("primitives[0].material",
          [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["material"] = 0; });
  refused("primitives[0].mode",
          [](GltfBuilder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 9; });
  refused("values without data", [](GltfBuilder& b) {
    b.json["accessors"][0] = {{"componentType", 5126}, {"count", 4000000000u}, {"type", "VEC3"}};
  });
  refused("multiply the file", [](GltfBuilder& b) {  // 20,000 nodes show 20,000 triangles each
    std::vector<float> zeros(60'000);
    b.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = b.add(zeros, "VEC3");
    for (int i = 0; i < 20'000; ++i) b.json["nodes"][static_cast<std::size_t>(i)] = {{"mesh", 0}};
  });
  refused("extensionsRequired[1]", [](GltfBuilder& b) {
    b.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_meshopt_compression"};
  });
  refused("asset.version", [](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; });
}

TEST_CASE("glTF: a file cut anywhere is refused") {
  const std::string whole = one_triangle().glb();
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    const std::vector<char> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(cut));
    CHECK_FALSE(import_bytes(std::as_bytes(std::span(part)), "cut.glb", {}).ok());
  }
}

TEST_CASE("glTF: buffers come from beside the file and from nowhere else") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("crease_gltf_" + std::to_string(std::rand()));
  std::filesystem::create_directories(folder / "inside" / "deep");
  const GltfBuilder b = one_triangle();
  const auto write = [](const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  };
  write(folder / "secret.bin", b.binary());
  write(folder / "inside" / "deep" / "a b.bin", b.binary());
  const auto import_with = [&](const std::string& uri) {
    const std::filesystem::path path = folder / "inside" / "model.gltf";
    write(path, b.gltf_beside(uri));
    return import_mesh(path, {});
  };
  CHECK(import_with("deep/a%20b.bin").ok());
  std::filesystem::create_symlink(folder / "secret.bin", folder / "inside" / "link.bin");
  for (const std::string& uri :
       {std::string("../secret.bin"), std::string("deep/../../secret.bin"), std::string("link.bin"),
        (folder / "secret.bin").string(), "file://" + (folder / "secret.bin").string(),
        std::string("%2e%2e/secret.bin"), std::string("deep"), std::string("missing.bin")}) {
    CAPTURE(uri);
    const Result<Imported> in = import_with(uri);
    REQUIRE_FALSE(in.ok());
    CHECK(in.failure().message.find("buffers[0].uri") != std::string::npos);
  }
  // Without a folder there are no files.
  CHECK(refusal_of(b.gltf_beside("deep/a%20b.bin"), "m.gltf").find("buffers[0].uri") !=
        std::string::npos);
  std::filesystem::remove_all(folder);
}

// Counts from the table of an independent checker (README beside the models).
TEST_CASE("glTF: real models have the counts of the independent table") {
  struct Expected {
    const char* name;
    std::size_t triangles, vertices;
    double sn_percent;
    const char* layer;
    std::size_t materials;
  };
  static constexpr Expected kExpected[] = {
      {"cad/2cylinder_engine.glb.xz", 121'496 - 11'160, 60'041, 61, "normal", 34},
      {"cad/building_blendswap.b3dm.xz", 66'094, 36'032, 1.4, "normal", 2},
      {"attributes/corset.glb", 18'324, 9'774, 100, "uv", 1},
      {"attributes/lantern.glb", 5'394, 2'737, 81, "uv", 1},
      {"attributes/boombox.glb", 6'036, 3'133, 97, "uv", 1},
      {"attributes/scallop_coloured_120k.glb.xz", 120'000, 60'002, 100, "color", 1},
      {"nasty/everything_wrong_station.glb.xz", 10'483, 3'451, 0.3, "uv", 44},
      {"nasty/parse_triangle_strips.gltf", 2'786, 1'476, 18, "normal", 1},
      {"nasty/values_bad_normals.glb", 12, 8, 0, "normal", 1},
  };
  for (const Expected& expected : kExpected) {
    const std::filesystem::path path = shared_model(expected.name);
    if (path.empty()) continue;
    CAPTURE(expected.name);
    const Result<Imported> in = import_mesh(path, {});
    REQUIRE(in.ok());
    const Mesh& mesh = in->mesh;
    CHECK(check_mesh(mesh).ok());
    CHECK(mesh.triangle_count() == expected.triangles);
    CHECK(mesh.vertex_count() == expected.vertices);
    CHECK(mesh.materials.size() == expected.materials);
    CHECK(std::ranges::count(mesh.layers, expected.layer, &AttributeLayer::name) == 1);
    const ShadingKinds kinds = classify_shading(mesh);
    const auto sn = std::ranges::count(kinds.of_vertex, VertexKind::SN);
    CHECK(std::abs(100.0 * double(sn) / double(mesh.vertex_count()) - expected.sn_percent) < 0.6);
  }
}

TEST_CASE("glTF: broken real files are refused with their place") {
  static constexpr std::pair<const char*, const char*> kExpected[] = {
      {"nasty/truncated_chunk.glb", "byte 8"},
      {"nasty/truncated_by_one.glb", "byte 8"},
      {"nasty/truncated_after_header.glb", "byte 12"},
      {"nasty/parse_bad_json.glb", "byte 21"},
      {"nasty/values_infinite.glb", "meshes[0].primitives[0].attributes.POSITION[0]"},
      {"nasty/gltf_loop/node_loop_scene.gltf", "nodes[0]"},
      {"nasty/gltf_noposition/primitive_no_position.gltf", "attributes.POSITION"},
      {"nasty/gltf_oob/index_buffer_oob.gltf", "meshes[0].primitives[0].indices[5]"},
  };
  for (const auto& [name, place] : kExpected) {
    const std::filesystem::path path = shared_model(name);
    if (path.empty()) continue;
    CAPTURE(name);
    const Result<Imported> in = import_mesh(path, {});
    REQUIRE_FALSE(in.ok());
    CAPTURE(in.failure().message);
    CHECK(in.failure().message.find(place) != std::string::npos);
  }
}

TEST_CASE("whole numbers that are no floats are rounded and told") {
  GltfBuilder b;
  const std::size_t positions = b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const std::size_t ids = b.add<std::uint32_t>({16777216, 16777217, 4294967295u}, "SCALAR");
  b.primitive({{"POSITION", positions}, {"_ID", ids}});
  const Imported in = import_text(b.glb(), "a.glb");
  CHECK(in.report.notes ==
        std::vector<std::string>{"2 values of 'ID' rounded to floats, by 1 at most"});
}

}  // namespace crease
