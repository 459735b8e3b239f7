#include "io/polygon_model.h"

#include "crease/export.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

namespace crease {
namespace {

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_CASE("all four forms of face corners are read") {
  const std::string values = kSquare + "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n";
  for (const char* face :
       {"f 1 2 3\n", "f 1/1 2/2 3/3\n", "f 1//1 2//1 3//2\n", "f 1/1/1 2/2/1 3/3/2\n"}) {
    CAPTURE(face);
    const Mesh mesh = import_text(values + face, "a.obj").mesh;
    CHECK(mesh.triangle_count() == 1);
    const bool has_uv = std::string_view(face).find("/2") != std::string_view::npos &&
                        std::string_view(face).find("2/2") != std::string_view::npos;
    const bool has_normals = std::string_view(face).find("/1 ") != std::string_view::npos &&
                             std::string_view(face).find("3/") != std::string_view::npos &&
                             std::string_view(face) != "f 1/1 2/2 3/3\n";
    CHECK(mesh.layers.size() == (has_uv ? 2 : 1));
    CHECK(mesh.normals()->value_count() == (has_normals ? 2 : 1));
  }
}

TEST_CASE("corners keep their own indices: one vertex, two normals, three texture coordinates") {
  const Mesh mesh = import_text(kSquare +
                                    "vt 0 0\nvt 0.5 0\nvt 0 0.25\nvn 0 0 1\nvn 0 1 0\n"
                                    "f 1/1/1 2/2/1 3/3/1\nf 1/2/2 3/3/1 4/1/1\n",
                                "a.obj")
                        .mesh;
  REQUIRE(mesh.layers.size() == 2);
  CHECK(mesh.layers[1].role == AttributeRole::TexCoord);
  CHECK(mesh.layers[0].value_count() == 2);
  CHECK(mesh.layers[1].value_count() == 3);
  CHECK(mesh.layers[0].of_corner[0] != mesh.layers[0].of_corner[3]);
  CHECK(mesh.layers[1].of_corner[2] == mesh.layers[1].of_corner[4]);
  const auto uv = mesh.layers[1].value(mesh.layers[1].of_corner[2]);
  CHECK(uv[0] == 0);
  CHECK(uv[1] == 0.25f);
}

TEST_CASE("faces may come before their vertices") {
  CHECK(import_text("f 1 2 3\n" + kSquare, "a.obj").mesh.triangle_count() == 1);
}

TEST_CASE("a backslash continues a line, and later lines keep their numbers") {
  CHECK(import_text(kSquare + "f 1 2 \\\n 3 \\\r\n 4\n", "a.obj").mesh.triangle_count() == 2);
  CHECK(refusal_of(kSquare + "f 1 2 \\\n 3\nf 1 2 9\n", "a.obj") ==
        "a.obj:7: face index 9 of 4 vertices");
}

TEST_CASE("a concave polygon is not cut as a fan") {
  //  3       1     The arrow 0 1 2 3 is concave at 2: the fan 0 1 2, 0 2 3 from another corner
  //   \ .2. /      would turn a triangle over.
  //     0
  const Mesh mesh = import_text("v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\nf 2 3 4 1\n", "a.obj").mesh;
  REQUIRE(mesh.triangle_count() == 2);
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d& p = mesh.positions[index_of(a)];
    CHECK(cross(mesh.positions[index_of(b)] - p, mesh.positions[index_of(c)] - p).z > 0);
  }
}

TEST_CASE("smoothing groups: soft within a group other than 0, hard elsewhere") {
  // A roof of two quads at 90 degrees.
  const std::string roof = "v 0 0 0\nv 0 4 0\nv 1 0 1\nv 1 4 1\nv 2 0 0\nv 2 4 0\n";
  const auto hard_count = [&](const char* groups_and_faces) {
    return hard_edges(import_text(roof + groups_and_faces, "a.obj").mesh).size();
  };
  CHECK(hard_count("s 1\nf 1 3 4 2\nf 3 5 6 4\n") == 0);
  CHECK(hard_count("s 1\nf 1 3 4 2\ns 2\nf 3 5 6 4\n") == 1);
  CHECK(hard_count("s off\nf 1 3 4 2\nf 3 5 6 4\n") == 1);
  CHECK(hard_count("f 1 3 4 2\nf 3 5 6 4\n") == 1);  // by angle
}

TEST_CASE("normals win over smoothing groups; the policy wins over both") {
  const std::string roof =
      "v 0 0 0\nv 0 4 0\nv 1 0 1\nv 1 4 1\nv 2 0 0\nv 2 4 0\nvn 0 0 1\n"
      "s off\nf 1//1 3//1 4//1 2//1\nf 3//1 5//1 6//1 4//1\n";
  CHECK(hard_edges(import_text(roof, "a.obj").mesh).empty());
  ImportOptions flat;
  flat.normals.kind = NormalPolicy::Kind::Flat;
  CHECK(hard_edges(import_text(roof, "a.obj", flat).mesh).size() == 1);
  ImportOptions smooth;
  smooth.normals.kind = NormalPolicy::Kind::Smooth;
  CHECK(hard_edges(import_text(roof, "a.obj", smooth).mesh).empty());
}

TEST_CASE("unit normals keep their bits, others are made unit, zero ones are replaced") {
  const Imported in = import_text(kSquare +
                                      "vn 0.6001 0 0.8\nvn 0 0 5\nvn 0 0 0\n"
                                      "f 1//1 2//2 3//3\n",
                                  "a.obj");
  const AttributeLayer& normals = *in.mesh.normals();
  CHECK(normals.value(normals.of_corner[0])[0] == 0.6001f);
  CHECK(normals.value(normals.of_corner[1])[2] == 1.0f);
  CHECK(normals.value(normals.of_corner[2])[2] == 1.0f);
  CHECK(in.report.zero_normals == 1);
}

TEST_CASE("bit-equal positions and values are one") {
  const Imported in = import_text(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 0 0\nv 2 0 0\nv 1 1 -0\nvn 0 0 1\nvn -0 0 1\n"
      "f 1//1 2//1 3//1\nf 4//2 5//2 6//2\n",
      "a.obj");
  CHECK(in.mesh.vertex_count() == 4);
  CHECK(in.report.welded_vertices == 2);
  CHECK(in.mesh.normals()->value_count() == 1);
}

TEST_CASE("groups, objects and materials") {
  const Mesh mesh =
      import_text(kSquare +
                      "o house\ng roof\nusemtl red tiles\nf 1 2 3\n"
                      "g wall\nusemtl brick\nf 1 3 4\ng roof\nusemtl red tiles\nf 1 2 4\n"
                      "g empty\n",
                  "a.obj")
          .mesh;
  CHECK(mesh.parts == std::vector<std::string>{"house/roof", "house/wall"});
  CHECK(mesh.part_of_triangle == std::vector<PartId>{PartId{0}, PartId{1}, PartId{0}});
  REQUIRE(mesh.materials.size() == 2);
  CHECK(mesh.materials[0].name == "red tiles");
  CHECK(mesh.material_of_triangle ==
        std::vector<MaterialId>{MaterialId{0}, MaterialId{1}, MaterialId{0}});
}

TEST_CASE("triangles before the first group or material have a nameless one") {
  const Mesh mesh = import_text(kSquare + "f 1 2 3\ng late\nusemtl late\nf 1 3 4\n", "a.obj").mesh;
  REQUIRE(mesh.parts.size() == 2);
  CHECK(mesh.parts[index_of(mesh.part_of_triangle[0])].empty());
  CHECK(mesh.parts[index_of(mesh.part_of_triangle[1])] == "late");
  CHECK(mesh.materials[index_of(mesh.material_of_triangle[0])].name.empty());
  CHECK(mesh.materials[index_of(mesh.material_of_triangle[1])].name == "late");
}

TEST_CASE("the material library beside the file is read") {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "crease_obj_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "my lib.mtl") << "newmtl red\nKd 1 0.5 0.25\nd 0.5\n"
                                          "map_Kd -s 1 1 1 -clamp on my tiles.png\n";
  std::ofstream(folder / "a.obj") << "mtllib my lib.mtl\nusemtl red\n" << kSquare << "f 1 2 3\n";
  const Result<Imported> in = import_mesh(folder / "a.obj", {});
  REQUIRE(in.ok());
  const Material expected{"red", {1, 0.5f, 0.25f, 0.5f}, "my tiles.png"};
  CHECK(in->mesh.materials == std::vector<Material>{expected});
  std::filesystem::remove_all(folder);
}

TEST_CASE("one line may name several material libraries") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_obj_test_libraries";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.mtl") << "newmtl red\nKd 1 0 0\n";
  std::ofstream(folder / "b.mtl") << "newmtl blue\nKd 0 0 1\n";
  const auto import_with = [&](const std::string& libraries) {
    std::ofstream(folder / "a.obj") << "mtllib " << libraries << "\nusemtl red\n"
                                    << kSquare << "f 1 2 3\nusemtl blue\nf 1 3 4\n";
    return *import_mesh(folder / "a.obj", {});
  };
  const Imported both = import_with("a.mtl  b.mtl");
  CHECK(both.report.notes.empty());
  CHECK(both.mesh.materials[0].base_color == std::array<float, 4>{1, 0, 0, 1});
  CHECK(both.mesh.materials[1].base_color == std::array<float, 4>{0, 0, 1, 1});
  CHECK(import_with("a.mtl c.mtl").report.notes ==
        std::vector<std::string>{"material library left out: no file 'c.mtl'",
                                 "1 material is in no library: without a colour ('blue')"});
  CHECK(import_with("c d.mtl").report.notes ==
        std::vector<std::string>{"material library left out: no file 'c d.mtl'"});
  std::filesystem::remove_all(folder);
}

TEST_CASE("colours after the coordinates of vertices") {
  const Mesh mesh = import_text("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n", "a.obj").mesh;
  REQUIRE(mesh.layers.size() == 2);
  const AttributeLayer& colors = mesh.layers[1];
  CHECK(colors.role == AttributeRole::Color);
  const auto white = colors.value(colors.of_corner[2]);
  CHECK(std::vector<float>(white.begin(), white.end()) == std::vector<float>{1, 1, 1});
  CHECK(colors.value(colors.of_corner[1])[1] == 1);
}

TEST_CASE("colours that ZBrush paints, in comments") {
  const std::string corners = "v 0 0 0\nv 1 0 0\n", more = "v 0 1 0\nf 1 2 3\n";
  const Imported in =
      import_text(corners + more + "#MRGB ffff0000ff00ff00\n#MRGB ff3366cc\n#\n", "a.obj");
  CHECK(in.report.notes.empty());
  const auto color = std::ranges::find(in.mesh.layers, AttributeRole::Color, &AttributeLayer::role);
  REQUIRE(color != in.mesh.layers.end());
  CHECK(color->value(color->of_corner[1])[1] == 1);
  CHECK(color->value(color->of_corner[2])[2] == doctest::Approx(0.8));
  CHECK(import_text(corners + "#MRGB ff000000\n" + more, "a.obj").report.notes ==
        std::vector<std::string>{
            "1 colours in comments ignored, as they are not those of the 3 vertices"});
}

TEST_CASE("every refusal names the line and the reason") {
  CHECK(refusal_of("v 0 0\nf 1 1 1\n", "a.obj") == "a.obj:1: vertex has too few numbers");
  CHECK(refusal_of("v 0 0 x\n", "a.obj") == "a.obj:1: vertex: not a number: 'x'");
  CHECK(refusal_of("v 0 0 0,5\n", "a.obj") == "a.obj:1: vertex: not a number: '0,5'");
  CHECK(refusal_of("\nv 0 nan 0\n", "a.obj") == "a.obj:2: vertex is not finite");
  // As Microsoft's libraries write it.
  for (const char* x : {"-1.#IND00", "1.#QNAN", "1.#QNAN0", "1.#INF", "-1.#INF00", "1.#SNAN"}) {
    CHECK(refusal_of("\nv 0 " + std::string(x) + " 0\n", "a.obj") ==
          "a.obj:2: vertex is not finite");
    const std::string values =
        std::string("vn ") + x + " 0 1\nvt " + x + " 0\nf 1/1/1 2/1/1 3/1/1\n";
    CHECK(import_text(kSquare + values, "a.obj").report.bad_attribute_values == 2);
  }
  CHECK(refusal_of("v 0 1.#INDEX 0\n", "a.obj").find("not a number: '1.#INDEX'") !=
        std::string::npos);
  CHECK(refusal_of("v 1e999 0 0\n", "a.obj") == "a.obj:1: vertex is not finite");
  CHECK(refusal_of("v 1e39 0 0\n", "a.obj") == "a.obj:1: vertex is beyond 1e30");
  CHECK(refusal_of(kSquare + "f 1 2 0\n", "a.obj") == "a.obj:5: face index 0: OBJ counts from 1");
  CHECK(refusal_of(kSquare + "f 1 2 -5\n", "a.obj") == "a.obj:5: face index -5 of 4 vertices");
  CHECK(refusal_of(kSquare + "f 1 2 99999999999999999999\n", "a.obj")
            .starts_with("a.obj:5: face corner"));
  CHECK(refusal_of(kSquare + "f 1 2 3/1/1/1\n", "a.obj").starts_with("a.obj:5: face corner"));
  CHECK(refusal_of(kSquare + "vn 0 0 1\nf 1//2 2//1 3//1\n", "a.obj") ==
        "a.obj:6: face index 2 of 1 normals");
  CHECK(refusal_of(kSquare, "a.obj") == "a.obj: no triangles in it");
  CHECK(refusal_of("hello\nworld\n", "a.obj").starts_with("a.obj:1: not an OBJ file"));
}

TEST_CASE("a position of city size keeps its millimetres") {
  const Mesh mesh = import_text(
                        "v 390123.001 5820456.002 34.5\nv 390123.002 5820456.002 34.5\n"
                        "v 390123.002 5820456.003 34.5\nf 1 2 3\n",
                        "a.obj")
                        .mesh;
  CHECK(mesh.positions[0].x == 390123.001);
  CHECK(mesh.positions[2].y == 5820456.003);
}

TEST_CASE("materials that no library has are told, and comments are none of their names") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_obj_unknown_material_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.mtl") << "newmtl steel # from CAD\nKd 1 0 0\n"
                                     "newmtl Material #25\nKd 0 1 0\nnewmtl glass\nKd 0 0 1\n";
  std::ofstream(folder / "a.obj")
      << "mtllib a.mtl # of the plant\n"
      << kSquare
      << "f 1 2 3\nusemtl steel\nf 1 2 3\nusemtl Material #25\nf 1 3 4\n"
         "usemtl glass # panes\nf 2 3 4\nusemtl undefined\nf 1 2 4\n";
  const Result<Imported> in = import_mesh(folder / "a.obj", {});
  REQUIRE(in.ok());
  const auto color_of = [&](std::size_t t) {
    return in->mesh.materials[index_of(in->mesh.material_of_triangle[t])].base_color;
  };
  CHECK(color_of(0) == std::array<float, 4>{1, 1, 1, 1});
  CHECK(color_of(1) == std::array<float, 4>{1, 0, 0, 1});
  CHECK(color_of(2) == std::array<float, 4>{0, 1, 0, 1});
  CHECK(color_of(3) == std::array<float, 4>{0, 0, 1, 1});
  CHECK(color_of(4) == std::array<float, 4>{1, 1, 1, 1});
  CHECK(std::ranges::count(in->report.notes,
                           "1 material is in no library: without a colour ('undefined')") == 1);
  std::filesystem::remove_all(folder);
}

TEST_CASE("parts and materials are written in one run each, and equal names are told apart") {
  Mesh mesh = import_text(kSquare + "f 1 2 3\nf 1 3 4\nf 1 2 4\nf 2 3 4\n", "a.obj").mesh;
  mesh.parts = {"one", "two"};
  mesh.materials = {{.name = "M"}, {.name = "M"}, {.name = "M_2"}, {.name = "M"}};
  for (std::uint32_t t = 0; t < 4; ++t) {
    mesh.part_of_triangle.push_back(PartId{t % 2});
    mesh.material_of_triangle.push_back(MaterialId{3 - t});
    mesh.materials[t].base_color = {0.25f * float(t), 0, 0, 1};
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_obj_runs_test";
  std::filesystem::create_directories(folder);
  REQUIRE(export_mesh(mesh, folder / "a.obj").ok());
  std::ifstream file(folder / "a.obj");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("o ") || line.starts_with("usemtl ")) lines.push_back(line);
  }
  CHECK(lines == std::vector<std::string>{"o one", "usemtl M_3", "usemtl M_4", "o two", "usemtl M",
                                          "usemtl M_2"});
  const Result<Imported> back = import_mesh(folder / "a.obj", {});
  REQUIRE(back.ok());
  CHECK(back->mesh.triangle_count() == 4);
  std::vector<float> reds;
  for (const MaterialId m : back->mesh.material_of_triangle) {
    reds.push_back(back->mesh.materials[index_of(m)].base_color[0]);
  }
  std::ranges::sort(reds);
  CHECK(reds == std::vector<float>{0, 0.25f, 0.5f, 0.75f});
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace crease
