// What vertices of a glTF carry, however it is stored, and materials.
#include "crease/import.h"
#include "io/gltf_triangle.h"
#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace crease {

namespace {

using Json = GltfBuilder::Json;

std::vector<float> value_at(const Mesh& mesh, const std::string& layer, std::size_t t,
                            std::size_t c) {
  for (const AttributeLayer& l : mesh.layers) {
    if (l.name != layer) continue;
    const auto value = l.value(l.of_corner[3 * t + c]);
    return {value.begin(), value.end()};
  }
  return {};
}

}  // namespace

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
  CHECK(value_at(mesh, "uv", 0, 0) == std::vector<float>{1, 1});   // v 0 is the top: 1 with v up
  const std::vector<float> color = value_at(mesh, "color", 0, 0);  // linear there, sRGB here
  CHECK(color[0] == 1);
  CHECK(color[1] == 0);
  CHECK(color[2] == doctest::Approx(0.484529));
  CHECK(color[3] == 1);
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

TEST_CASE("glTF: the texture coordinates that textures use are the first, wherever they are met") {
  const auto uv_layers = [](const GltfBuilder& b) {
    std::vector<std::string> names;
    for (const AttributeLayer& layer : import_text(b.gltf(), "a.gltf").mesh.layers) {
      if (layer.role == AttributeRole::TexCoord) names.push_back(layer.name);
    }
    return names;
  };
  GltfBuilder b = one_triangle();
  Json& primitive = b.json["meshes"][0]["primitives"][0];
  for (std::size_t set = 0; set < 3; ++set) {
    const float s = float(set);
    primitive["attributes"]["TEXCOORD_" + std::to_string(set)] =
        b.add<float>({s, 0, s, 0, s, 0}, "VEC2");
  }
  primitive["material"] = 0;
  b.json["textures"] = {{{"source", 0}}};
  b.json["images"] = {{{"uri", "brick.png"}}};
  Json& texture = b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture = {{"index", 0}};
  for (std::size_t set = 0; set < 3; ++set) {
    CAPTURE(set);
    texture["texCoord"] = set;
    CHECK(uv_layers(b).size() == 3);
    CHECK(uv_layers(b)[0] == "uv");
    const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
    CHECK(value_at(mesh, "uv", 0, 0)[0] == float(set));
    if (set > 0) CHECK(value_at(mesh, "uv" + std::to_string(set), 0, 0)[0] == 0);
  }
  // One without a texture comes before, and has another set alone.
  GltfBuilder two = one_triangle();
  two.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
      two.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  CHECK(uv_layers(two) == std::vector<std::string>{"uv1"});
  two.primitive({{"POSITION", two.add<float>({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3")},
                 {"TEXCOORD_0", two.add<float>({0, 0, 1, 0, 0, 1}, "VEC2")}});
  CHECK(uv_layers(two) == std::vector<std::string>{"uv", "uv1"});
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

TEST_CASE("glTF: what materials say beyond a base colour is told, kind by kind") {
  const auto notes_of = [](GltfBuilder::Json materials) {
    GltfBuilder b = one_triangle();
    b.json["materials"] = std::move(materials);
    b.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    b.json["images"] = {{{"uri", "leaf.png"}}};
    b.json["samplers"] = {{{"wrapS", 33071}, {"magFilter", 9728}}};
    return import_text(b.gltf(), "m.gltf").report.notes;
  };
  using Notes = std::vector<std::string>;
  const GltfBuilder::Json plain = {{"metallicFactor", 0}};
  const GltfBuilder::Json texture = {{"index", 0}};
  CHECK(notes_of({{{"pbrMetallicRoughness", plain}, {"emissiveFactor", {0, 0, 0}}}}).empty());
  CHECK(notes_of({{{"name", "metal, if nothing else is said"}}, {{"name", "too"}}}) ==
        Notes{"2 materials lose metallic and roughness"});
  CHECK(notes_of({{{"pbrMetallicRoughness", plain},
                   {"alphaMode", "MASK"},
                   {"alphaCutoff", 0.3},
                   {"doubleSided", true},
                   {"emissiveFactor", {1, 0.5, 0}}},
                  {{"pbrMetallicRoughness", plain}, {"doubleSided", true}}}) ==
        Notes{"a material loses emission"});
  CHECK(notes_of(
            {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0, 0, 0, 1}}}},
              {"emissiveFactor", {1, 0.5, 0}}}}) ==
        Notes{"a material is black but for emission, which becomes the base colour"});
  CHECK(notes_of({{{"pbrMetallicRoughness",
                    {{"metallicFactor", 0}, {"metallicRoughnessTexture", texture}}},
                   {"normalTexture", texture},
                   {"occlusionTexture", texture}}}) ==
        Notes{"a material loses metallic and roughness", "a material loses normalTexture",
              "a material loses occlusionTexture"});
  CHECK(notes_of({{{"pbrMetallicRoughness", {{"baseColorTexture", texture}}},
                   {"alphaMode", "BLEND"},
                   {"extensions", {{"KHR_materials_unlit", GltfBuilder::Json::object()}}}}}) ==
        Notes{"a material loses 'KHR_materials_unlit'",
              "a material loses wrapS or wrapT, which become REPEAT",
              "a material loses magFilter NEAREST"});
}

TEST_CASE("glTF: what is black but for emission is painted with that") {
  GltfBuilder b = one_triangle();
  b.json["materials"] = {{{"pbrMetallicRoughness",
                           {{"metallicFactor", 0},
                            {"baseColorFactor", {0, 0, 0, 1}},
                            {"baseColorTexture", {{"index", 0}}}}},
                          {"emissiveFactor", {1, 0.5, 3}},
                          {"emissiveTexture", {{"index", 1}}}}};
  b.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  b.json["images"] = {{{"uri", "black.png"}}, {{"uri", "lamp.png"}}};
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  const Mesh mesh = import_text(b.gltf(), "m.gltf").mesh;
  CHECK(mesh.materials[0].base_color == std::array<float, 4>{1, 0.5f, 1, 1});
  CHECK(mesh.materials[0].base_color_texture == "lamp.png");
}

TEST_CASE("glTF: techniques of glTF 1.0 may be required, and are lost like other materials") {
  GltfBuilder b = one_triangle();
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_techniques_webgl"};
  b.json["materials"] = {{{"extensions", {{"KHR_techniques_webgl", {{"technique", 0}}}}}}};
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  const Imported in = import_text(b.gltf(), "m.gltf");
  CHECK(in.mesh.triangle_count() == 1);
  CHECK(in.report.notes == std::vector<std::string>{"a material loses 'KHR_techniques_webgl'"});
}

TEST_CASE("glTF: alpha counts where it blends") {
  for (const auto& [mode, alpha] :
       {std::pair("OPAQUE", 1.0f), std::pair("MASK", 1.0f), std::pair("BLEND", 0.25f)}) {
    GltfBuilder b = one_triangle();
    b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}}};
    if (std::string(mode) != "OPAQUE") b.json["materials"][0]["alphaMode"] = mode;
    CHECK(import_text(b.gltf(), "m.gltf").mesh.materials[0].base_color[3] == alpha);
    CHECK_FALSE(import_text(b.gltf(), "m.gltf").mesh.materials[0].is_blended);  // alpha says it
  }
  // That of textures and colours has nothing else to say it.
  GltfBuilder b = one_triangle();
  b.json["materials"] = {{{"alphaMode", "BLEND"}}};
  CHECK(import_text(b.gltf(), "m.gltf").mesh.materials[0].is_blended);
}

TEST_CASE("glTF: holes and two sides are kept, the factor's alpha within the cutoff") {
  struct Case {
    GltfBuilder::Json cutoff, factor;
    float expected;
  };
  for (const Case& c : {Case{nullptr, 1, 0.5f}, Case{0.25, 1, 0.25f}, Case{0.25, 0.5, 0.5f},
                        Case{0, 0.5, 0}, Case{0.5, 0, 2}, Case{-1, 1, 0}}) {
    GltfBuilder b = one_triangle();
    b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, c.factor}}}},
                            {"alphaMode", "MASK"},
                            {"doubleSided", true}}};
    if (!c.cutoff.is_null()) b.json["materials"][0]["alphaCutoff"] = c.cutoff;
    const Mesh mesh = import_text(b.gltf(), "m.gltf").mesh;
    CHECK(mesh.materials[0].alpha_cutoff == c.expected);
    CHECK(mesh.materials[0].double_sided);
    CHECK(mesh.materials[0].base_color[3] == 1);
  }
}

TEST_CASE("glTF: whole numbers that are no floats are rounded and told") {
  GltfBuilder b;
  const std::size_t positions = b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  const std::size_t ids = b.add<std::uint32_t>({16777216, 16777217, 4294967295u}, "SCALAR");
  b.primitive({{"POSITION", positions}, {"_ID", ids}});
  const Imported in = import_text(b.glb(), "a.glb");
  CHECK(in.report.notes ==
        std::vector<std::string>{"2 values of 'ID' rounded to floats, by 1 at most"});
}

}  // namespace crease
