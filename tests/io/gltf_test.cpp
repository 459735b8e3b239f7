// Triangles of a glTF and where its nodes put them.
#include "crease/export.h"
#include "crease/import.h"
#include "io/gltf_triangle.h"
#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace crease {

namespace {

Vec3d face_normal(const Mesh& mesh, std::size_t t) {
  return normalized(
      cross(corner(mesh, t, 1) - corner(mesh, t, 0), corner(mesh, t, 2) - corner(mesh, t, 0)));
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

GltfBuilder triangle_at_a_node() {
  GltfBuilder b;
  b.primitive({{"POSITION", b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")}});
  b.json["nodes"] = {{{"mesh", 0}}};
  b.json["scenes"] = {{{"nodes", {0}}}};
  return b;
}

}  // namespace

TEST_CASE("glTF: the cube and the cylinder keep their hard edges in every container") {
  for (const PolygonModel& model : polygon_models()) {
    CAPTURE(model.name);
    const GltfBuilder b = split_model(model);
    for (const auto& [text, file] :
         {std::pair(b.gltf(), "model.gltf"), std::pair(b.glb(), "model.glb"),
          std::pair(b.b3dm(), "model.b3dm")}) {
      const std::string name = file;
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

TEST_CASE("glTF: the only node keeps its name, or its mesh's, there and back") {
  GltfBuilder b = triangle_at_a_node();
  CHECK(import_text(b.gltf(), "a.gltf").mesh.parts.empty());
  b.json["meshes"][0]["name"] = "shape";
  CHECK(import_text(b.gltf(), "a.gltf").mesh.parts == std::vector<std::string>{"shape"});
  b.json["nodes"][0]["name"] = "hero";
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(mesh.parts == std::vector<std::string>{"hero"});
  const auto written = export_bytes(mesh, ".glb");
  REQUIRE(written.ok());
  const auto back = import_bytes(*written, "back.glb", {});
  REQUIRE(back.ok());
  CHECK(back->mesh.parts == mesh.parts);
}

TEST_CASE("glTF: EXT_mesh_gpu_instancing puts a mesh at many places") {
  GltfBuilder b = triangle_at_a_node();
  const Vec3d before = corner(import_text(b.gltf(), "a.gltf").mesh, 0, 1);
  b.json["nodes"][0]["translation"] = {100, 0, 0};
  nlohmann::json& extension = b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"];
  extension["attributes"]["TRANSLATION"] = b.add<float>({0, 0, 0, 0, 5, 0, 0, 0, 7}, "VEC3");
  // About z by 90 degrees the second, as normalized shorts.
  extension["attributes"]["ROTATION"] =
      b.add<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170, 0, 0, 0, 32767}, "VEC4", true);
  extension["attributes"]["SCALE"] = b.add<float>({1, 1, 1, 1, 1, 1, 2, 2, -2}, "VEC3");
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const Imported in = import_text(b.gltf(), "a.gltf");
  CHECK(in.report.notes.empty());
  REQUIRE(in.mesh.triangle_count() == 3);
  CHECK(corner(in.mesh, 0, 1) == before + Vec3d{100, 0, 0});
  const Vec3d turned = corner(in.mesh, 1, 1) - Vec3d{100, 5, 0};
  CHECK(turned[0] == doctest::Approx(-before[1]).epsilon(1e-4));
  CHECK(turned[1] == doctest::Approx(before[0]).epsilon(1e-4));
  // The third is mirrored: its winding turns over.
  const Vec3d flipped = corner(in.mesh, 2, 2) - Vec3d{100, 0, 7};
  CHECK(flipped == Vec3d{2 * before[0], 2 * before[1], -2 * before[2]});

  extension["attributes"]["_COLOR_0"] = b.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3");
  CHECK(import_text(b.gltf(), "a.gltf").report.notes ==
        std::vector<std::string>{"1 nodes have instances whose '_COLOR_0' is ignored"});

  extension["attributes"]["SCALE"] = b.add<float>({1, 1, 1}, "VEC3");
  CHECK(refusal_of(b.gltf(), "a.gltf").ends_with("SCALE: not a value for every instance"));
  extension["attributes"] = {{"_ID", 0}};
  CHECK(refusal_of(b.gltf(), "a.gltf").find("how many instances") != std::string::npos);
}

TEST_CASE("glTF: instances are held against the size of the file") {
  GltfBuilder b = triangle_at_a_node();
  const std::size_t places =
      b.add_accessor({{"componentType", 5126}, {"count", 200'000}, {"type", "VEC3"}});
  for (int i = 0; i < 40; ++i) {
    nlohmann::json& node = b.json["nodes"][i];
    node["mesh"] = 0;
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
  }
  b.json.erase("scenes");
  CHECK(refusal_of(b.gltf(), "a.gltf").find("beyond reason") != std::string::npos);
}

TEST_CASE("glTF: what KHR_node_visibility hides is left out, and said") {
  GltfBuilder b = triangle_at_a_node();
  b.json["nodes"] = {
      {{"mesh", 0}, {"name", "seen"}},
      {{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
      {{"mesh", 0}, {"name", "hidden"}, {"translation", {5, 0, 0}}}};
  b.json["scenes"] = {{{"nodes", {0, 1}}}};
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_node_visibility"};
  const Imported in = import_text(b.gltf(), "a.gltf");
  CHECK(in.mesh.triangle_count() == 1);
  CHECK(in.mesh.parts == std::vector<std::string>{"seen"});
  CHECK(has_note(in.report, "1 nodes that KHR_node_visibility hides left out"));
}

TEST_CASE("glTF: what no node of the scene shows is left out, and said") {
  GltfBuilder b = triangle_at_a_node();
  CHECK(import_text(b.gltf(), "a.gltf").report.notes.empty());
  b.json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
  b.json["scenes"].push_back({{"nodes", {1}}});
  b.json["meshes"].push_back(b.json["meshes"][0]);
  for (int scene = 0; scene < 2; ++scene) {
    b.json["scene"] = scene;
    const Imported in = import_text(b.gltf(), "a.gltf");
    CHECK(corner(in.mesh, 0, 0) == Vec3d{5.0 * scene, 0, 0});
    CHECK(in.mesh.triangle_count() == 1);
    CHECK(in.report.notes ==
          std::vector<std::string>{"1 nodes with meshes left out: not in the scene",
                                   "1 meshes left out: no node has them"});
  }
}

TEST_CASE("glTF: what is not taken is told") {
  GltfBuilder b = triangle_at_a_node();
  b.json["cameras"] = {{{"type", "perspective"}}};
  b.json["extensions"] = {
      {"KHR_lights_punctual", {{"lights", {{{"type", "point"}}, {{"type", "spot"}}}}}},
      {"KHR_materials_variants", {{"variants", {{{"name", "red"}}}}}},
      {"EXT_structural_metadata", {{"propertyTables", {{{"class", "tree"}, {"count", 4}}}}}}};
  const ImportReport report = import_text(b.gltf(), "a.gltf").report;
  for (const char* note : {"1 cameras ignored", "2 lights ignored", "1 variants of materials",
                           "1 tables of EXT_structural_metadata"}) {
    CHECK(has_note(report, note));
  }
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

TEST_CASE("glTF: morph targets move colours and texture coordinates as well") {
  GltfBuilder b = triangle_at_a_node();
  GltfBuilder::Json& primitive = b.json["meshes"][0]["primitives"][0];
  const auto red = b.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  const auto less_red = b.add<float>({-2, 0, 1, -2, 0, 1, -2, 0, 1}, "VEC3");
  const auto uv = b.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  primitive["attributes"]["COLOR_0"] = red;
  primitive["attributes"]["TEXCOORD_0"] = primitive["attributes"]["TEXCOORD_1"] = uv;
  primitive["targets"] = {{{"COLOR_0", less_red}, {"TEXCOORD_0", uv}, {"TEXCOORD_1", uv}}};
  b.json["meshes"][0]["weights"] = {1.0};
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  REQUIRE(mesh.layers.size() == 4);
  CHECK(mesh.layers[1].name == "color");
  CHECK(mesh.layers[1].values == std::vector<float>{0, 0, 1});  // kept within 0 and 1
  for (const std::size_t layer : {2u, 3u}) {                    // once, though they share values
    const AttributeLayer& uvs = mesh.layers[layer];
    CHECK(uvs.role == AttributeRole::TexCoord);
    CHECK(uvs.value(uvs.of_corner[1])[0] == 2);
  }
}

// The sum is no number of the accessor's any more.
TEST_CASE("glTF: what morph targets make of normalized integers is not divided once more") {
  GltfBuilder b = triangle_at_a_node();
  GltfBuilder::Json& primitive = b.json["meshes"][0]["primitives"][0];
  const auto normalized = [&](const std::vector<std::int16_t>& values) {
    const std::size_t accessor = b.add<std::int16_t>(values, "VEC3");
    b.json["accessors"][accessor]["normalized"] = true;
    return accessor;
  };
  primitive["attributes"]["POSITION"] = normalized({0, 0, 32767, 32767, 0, 32767, 0, 32767, 32767});
  primitive["targets"] = {{{"POSITION", normalized({0, 0, 32767, 0, 0, 32767, 0, 0, 32767})}}};
  b.json["meshes"][0]["weights"] = {0.5};
  b.json["nodes"][0].erase("weights");
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{1, 0, 1.5});
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

// One strip of squares, of which each primitive has a few: in buffers of their own, or all in one.
TEST_CASE("glTF: primitives that share their vertices are as those with their own") {
  constexpr std::size_t kPrimitives = 40, kSquares = 5;
  constexpr std::size_t kOwn = 2 * (kSquares + 1);
  std::vector<float> positions, texcoords;
  std::vector<std::uint8_t> colors;
  for (std::size_t i = 0; i < kPrimitives * kOwn; ++i) {
    const auto x = float(i / 2);
    positions.insert(positions.end(), {x, float(i % 2), x * x / 1000});
    texcoords.insert(texcoords.end(), {x / 500, float(i % 2)});
    for (int k = 0; k < 4; ++k)
      colors.push_back(static_cast<std::uint8_t>(7 * i + 31 * std::size_t(k)));
  }
  const auto part = [](const auto& values, std::size_t components, std::size_t p) {
    const auto first = values.begin() + std::ptrdiff_t(p * kOwn * components);
    return std::decay_t<decltype(values)>(first, first + std::ptrdiff_t(kOwn * components));
  };
  GltfBuilder shared, own;
  const std::size_t all_positions = shared.add(positions, "VEC3"),
                    all_texcoords = shared.add(texcoords, "VEC2"),
                    all_colors = shared.add(colors, "VEC4", true);
  for (std::size_t p = 0; p < kPrimitives; ++p) {
    std::vector<std::uint16_t> indices, in_all;
    for (std::size_t i = 0; i < kSquares; ++i) {
      for (const std::size_t corner : {0, 2, 3, 0, 3, 1}) {
        indices.push_back(static_cast<std::uint16_t>(2 * i + corner));
        in_all.push_back(static_cast<std::uint16_t>(p * kOwn + 2 * i + corner));
      }
    }
    shared.primitive(
        {{"POSITION", all_positions}, {"TEXCOORD_0", all_texcoords}, {"COLOR_0", all_colors}},
        shared.add(in_all, "SCALAR"));
    own.primitive({{"POSITION", own.add(part(positions, 3, p), "VEC3")},
                   {"TEXCOORD_0", own.add(part(texcoords, 2, p), "VEC2")},
                   {"COLOR_0", own.add(part(colors, 4, p), "VEC4", true)}},
                  own.add(indices, "SCALAR"));
  }
  const Imported a = import_text(shared.glb(), "a.glb"), b = import_text(own.glb(), "b.glb");
  CHECK(a.mesh.positions == b.mesh.positions);
  CHECK(a.mesh.triangles == b.mesh.triangles);
  REQUIRE(a.mesh.layers.size() == 3);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(a.mesh.layers[k].values == b.mesh.layers[k].values);
    CHECK(a.mesh.layers[k].of_corner == b.mesh.layers[k].of_corner);
  }
  CHECK(a.mesh.triangle_count() == 2 * kPrimitives * kSquares);
  CHECK(a.report.welded_vertices == b.report.welded_vertices);

  // What is wrong with one of them is named by its place in the accessor.
  positions[3 * 25] = std::numeric_limits<float>::infinity();
  GltfBuilder broken;
  broken.primitive({{"POSITION", broken.add(positions, "VEC3")}},
                   broken.add(std::vector<std::uint16_t>{24, 25, 26}, "SCALAR"));
  CHECK(refusal_of(broken.glb(), "c.glb").find("POSITION[25]: position is") != std::string::npos);
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

TEST_CASE("b3dm: the centre of a tile is added, turned to y-up") {
  const GltfBuilder b = one_triangle();
  const Mesh mesh =
      import_text(b.b3dm(R"({"BATCH_LENGTH":0,"RTC_CENTER":[100,200,300]})"), "t.b3dm").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{101, 300, -200});
}

TEST_CASE("b3dm: what a batch table says is not kept, and said") {
  const GltfBuilder b = one_triangle();
  const auto notes = [&](const std::string& batches) {
    return import_text(b.b3dm("{}", "", batches), "t.b3dm").report.notes;
  };
  CHECK(notes("").empty());
  CHECK(notes("{}").empty());
  CHECK(notes(R"({"name":["house"],"height":[3]})") ==
        std::vector<std::string>{"2 properties of the batch table ignored: batch ids are kept, "
                                 "what they stand for is not"});
  CHECK(notes("name") == std::vector<std::string>{"a batch table that is no JSON object ignored"});
}

TEST_CASE("b3dm: the centre of a tile may be in the binary part of its table") {
  const GltfBuilder b = one_triangle();
  const float numbers[] = {0, 100, 200, 300};
  const std::string binary(reinterpret_cast<const char*>(numbers), sizeof numbers);
  const auto tile = [&](const std::string& center) {
    return b.b3dm(R"({"BATCH_LENGTH":0,"RTC_CENTER":)" + center + "}", binary);
  };
  const Mesh mesh = import_text(tile(R"({"byteOffset":4})"), "t.b3dm").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{101, 300, -200});
  CHECK(refusal_of(tile(R"({"byteOffset":8})"), "t.b3dm") ==
        "t.b3dm: RTC_CENTER.byteOffset: 8 of 16 bytes does not leave three floats");
  CHECK(refusal_of(tile("\"here\""), "t.b3dm").find("RTC_CENTER: neither") != std::string::npos);
}

}  // namespace crease
