// Files: broken ones, those beside a glTF, real ones.
#include "crease/import.h"
#include "crease/shading.h"
#include "io/gltf_triangle.h"
#include "io/polygon_model.h"
#include "io/text.h"
#include "support/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace crease {

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
    b.json["extensionsRequired"] = {"KHR_texture_transform", "KHR_other_compression"};
  });
  refused("asset.version", [](GltfBuilder& b) { b.json["asset"]["version"] = "1.0"; });
  for (const char* least : {"2.1", "3.0", "10.0"}) {
    refused("asset.minVersion: needs glTF",
            [&](GltfBuilder& b) { b.json["asset"]["minVersion"] = least; });
  }
  refused("scene: no such scene: the file has 1", [](GltfBuilder& b) {
    b.json["scenes"] = {{{"nodes", {0}}}};
    b.json["scene"] = 5;
  });
}

TEST_CASE("glTF: a stride of 0 is none") {
  GltfBuilder b = one_triangle();
  b.json["bufferViews"][0]["byteStride"] = 0;
  CHECK(import_text(b.gltf(), "m.gltf").mesh.triangle_count() == 1);
}

TEST_CASE("glTF: what is none of its three forms is told so") {
  for (const std::string text : {"error\x01", "  ", "[]"}) {
    CHECK(refusal_of(text, "tile.b3dm") ==
          "tile.b3dm: byte 0: neither GLB nor b3dm nor a JSON object");
  }
  CHECK(refusal_of("{\"asset\":", "a.gltf") == "a.gltf: byte 9: JSON ends early");
}

TEST_CASE("glTF: the least version that a file needs may be what is read") {
  GltfBuilder b = one_triangle();
  b.json["asset"]["minVersion"] = "2.0";
  CHECK(import_text(b.gltf(), "a.gltf").mesh.triangle_count() == 1);
}

TEST_CASE("glTF: names are in messages as they are, but for what a terminal would do") {
  CHECK(refusal_of(one_triangle().gltf_beside("Füße 東.bin"), "a.gltf").find("'Füße 東.bin'") !=
        std::string::npos);
  CHECK(in_quotes("\x1b[2J\x7f\xc2\x9b.") == "'?[2J???.'");
  CHECK(in_quotes("a\xc3") == "'a?'");                                  // cut off
  CHECK(in_quotes("\xc0\xaf \xed\xa0\x80.") == "'?? ???.'");            // too long, a surrogate
  CHECK(in_quotes("\xf4\x90\x80\x80 \xf0\x9f\x8c\x8d") == "'???? 🌍'");  // beyond the last
  std::string forty;
  for (int i = 0; i < 40; ++i) forty += "東";
  CHECK(in_quotes(forty) == "'" + forty + "'");
  CHECK(in_quotes(forty + "x") == "'" + forty + "...'");
}

TEST_CASE("glTF: a primitive without POSITION is skipped where there are others") {
  GltfBuilder b = one_triangle();
  b.primitive({{"NORMAL", b.add(kTriangle, "VEC3")}});
  b.primitive({{"POSITION", b.add<float>({0, 0, 1, 1, 0, 1, 0, 1, 1}, "VEC3")}});
  const Imported in = import_text(b.gltf(), "a.gltf");
  CHECK(in.mesh.triangle_count() == 2);
  CHECK(in.report.notes == std::vector<std::string>{"1 primitives without POSITION ignored"});
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

TEST_CASE("glTF: what a file may ask for grows with its buffers, beside it as inside") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("crease_gltf_size_" + std::to_string(std::rand()));
  std::filesystem::create_directories(folder);
  const auto import_beside = [&](const GltfBuilder& b, const std::string& gltf) {
    std::ofstream(folder / "model.bin", std::ios::binary) << b.binary();
    std::ofstream(folder / "model.gltf", std::ios::binary) << gltf;
    return import_mesh(folder / "model.gltf", {});
  };
  // 700,000 triangles are more than 1000 of each byte of the JSON.
  GltfBuilder b = one_triangle();
  std::vector<std::uint8_t> indices(2'100'000);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint8_t>(i % 3);
  b.json["meshes"][0]["primitives"][0]["indices"] = b.add(indices, "SCALAR");
  for (const std::string& gltf : {b.gltf(), b.gltf_beside("model.bin")}) {
    const Result<Imported> in = import_beside(b, gltf);
    REQUIRE_MESSAGE(in.ok(), (in.ok() ? "" : in.failure().message));
    CHECK(in->mesh.triangle_count() == 700'000);
  }

  GltfBuilder zeros = one_triangle();
  zeros.add_view(std::vector<char>(10'000));
  const auto ask_for = [&](std::size_t count) {
    zeros.json["accessors"][0] = {{"componentType", 5126}, {"count", count}, {"type", "VEC3"}};
    nlohmann::json gltf = nlohmann::json::parse(zeros.gltf_beside("model.bin"));
    for (std::size_t i = 1; i < 100; ++i) gltf["buffers"][i] = gltf["buffers"][0];
    return import_beside(zeros, gltf.dump());
  };
  const Result<Imported> no_area = ask_for(600'000), refused = ask_for(2'000'000);
  REQUIRE_FALSE(no_area.ok());
  CHECK(no_area.failure().error == Error::NoTriangles);
  REQUIRE_FALSE(refused.ok());  // a file counts once
  CHECK(refused.failure().message.find("values without data") != std::string::npos);
  std::filesystem::remove_all(folder);
}

// Counts from the table of an independent checker (README beside the models), who joins what is
// equal to the bit.
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
      {"nasty/parse_triangle_strips.gltf", 2'786, 1'375, 4.8, "normal",
       1},  // 1,476 and 18 to the bit
      {"nasty/values_bad_normals.glb", 12, 8, 0, "normal", 1},
  };
  for (const Expected& expected : kExpected) {
    const std::filesystem::path path = shared_model(expected.name);
    if (path.empty()) continue;
    CAPTURE(expected.name);
    const Result<Imported> in = import_mesh(path, {.precision = Precision{.bits = 30}});
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
    CAPTURE(path);
    const Result<Imported> in = import_mesh(path, {});
    REQUIRE_FALSE(in.ok());
    CAPTURE(in.failure().message);
    CHECK(in.failure().message.find(place) != std::string::npos);
  }
}

}  // namespace crease
