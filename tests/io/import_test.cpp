#include "crease/import.h"

#include "crease/export.h"
#include "io/polygon_model.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace crease {
namespace {

TEST_CASE("a model that is too small for numbers is refused, a small one is not") {
  const auto triangle = [](const std::string& side) {
    return "v 5 0 0\nv 5 " + side + " 0\nv 5 0 " + side + "\nf 1 2 3\n";
  };
  const Imported small = import_text(triangle("1e-30"), "a.obj");
  CHECK(small.mesh.triangle_count() == 1);
  REQUIRE(small.report.notes.size() == 1);
  CHECK(small.report.notes[0].starts_with("its longest side is 1e-30: views"));
  CHECK(import_text(triangle("2e18"), "a.obj").report.notes.size() == 1);
  CHECK(import_text(triangle("1e-19"), "a.obj").report.notes.empty());
  CHECK(refusal_of(triangle("1e-310"), "a.obj") ==
        "a.obj: its longest side is 1e-310, which leaves no numbers to work with: scale it up");
}

TEST_CASE("normal policies are read from words") {
  CHECK(parse_normal_policy("keep")->kind == NormalPolicy::Kind::Keep);
  CHECK(parse_normal_policy("flat")->kind == NormalPolicy::Kind::Flat);
  CHECK(parse_normal_policy("smooth")->kind == NormalPolicy::Kind::Smooth);
  const Result<NormalPolicy> crease = parse_normal_policy("crease:42.5");
  REQUIRE(crease.ok());
  CHECK(crease->kind == NormalPolicy::Kind::Crease);
  CHECK(crease->crease_angle_deg == 42.5);
  for (const char* bad :
       {"", "crease", "crease:", "crease:x", "crease:181", "crease:-1", "crease:nan", "Flat"}) {
    CAPTURE(bad);
    REQUIRE(!parse_normal_policy(bad).ok());
    CHECK(parse_normal_policy(bad).failure().error == Error::CommandLine);
  }
}

TEST_CASE("a file without an ending is told by its first bytes") {
  CHECK(import_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "model").report.format == "OBJ");
  CHECK(import_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "model").report.format == "OFF");
  CHECK(refusal_of("\x7f"
                   "ELF and more",
                   "model")
            .find("not a format known here") != std::string::npos);
  CHECK(refusal_of("", "a.obj") == "a.obj: byte 0: empty file");
}

TEST_CASE("a file that is not there is not found") {
  const Result<Imported> missing = import_mesh("/no/such/folder/a.obj", {});
  REQUIRE(!missing.ok());
  CHECK(missing.failure().error == Error::NotFound);
  CHECK(missing.failure().message.starts_with("/no/such/folder/a.obj: cannot be opened"));
}

TEST_CASE("import stops when it is asked to") {
  ImportOptions options;
  options.progress = [](const char*, double) { return false; };
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Result<Imported> got = import_bytes(std::as_bytes(std::span(obj)), "a.obj", options);
  REQUIRE(!got.ok());
  CHECK(got.failure().error == Error::Interrupted);
}

TEST_CASE("lines may end in carriage returns alone") {
  for (const auto& [file, text] :
       {std::pair("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        std::pair("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        std::pair("a.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                  "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        std::pair("a.stl",
                  "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                  "vertex 0 1 0\nendloop\nendfacet\nendsolid a b\n")}) {
    const std::string name = file;
    std::string returns = text;
    std::ranges::replace(returns, '\n', '\r');
    CAPTURE(name);
    CHECK(import_text(returns, name).mesh.positions == import_text(text, name).mesh.positions);
  }
}

TEST_CASE("what is ugly is counted") {
  const Imported in = import_text(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nv 2 0 0\nv 1 0 0\n"
      "f 1 2 3\nf 3 2 1\nf 1 2 6\nf 1 2 5\nf 1 2\n",
      "a.obj");
  CHECK(in.report.degenerate_triangles == 1);
  CHECK(in.report.duplicate_triangles == 1);
  CHECK(in.report.zero_area_triangles == 1);
  CHECK(in.report.isolated_vertices == 1);
  CHECK(in.report.welded_vertices == 1);
  CHECK(in.mesh.triangle_count() == 3);
}

TEST_CASE(
    "triangles that an exporter's rounding tore apart are one surface on a grid that joins them") {
  const PolygonModel cylinder = polygon_cylinder();
  std::string obj;
  int count = 0;
  for (const std::array<std::uint32_t, 3>& t : cylinder.triangles()) {
    for (const std::uint32_t v : t) {
      const Vec3d& p = cylinder.positions[v];
      char line[100];
      const double off = 1e-6 * (count++ % 5);
      std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", p.x + off, p.y - off, p.z + off);
      obj += line;
    }
    obj += "f -3 -2 -1\n";
  }
  const auto hard_count = [&](double length) {
    return hard_edges(import_text(obj, "a.obj", {.precision = Precision{.length = length}}).mesh)
        .size();
  };
  const Imported loose = import_text(obj, "a.obj");
  CHECK(loose.mesh.vertex_count() > 2 * cylinder.positions.size());
  REQUIRE(loose.report.notes.size() == 1);
  const std::string& note = loose.report.notes[0];
  const std::size_t at = note.find("--precision ");
  REQUIRE(at != note.npos);
  const double told = std::stod(note.substr(at + 12));
  CHECK(told < 1e-4);
  const Imported joined = import_text(obj, "a.obj", {.precision = Precision{.length = told}});
  CHECK(joined.mesh.vertex_count() == cylinder.positions.size());
  CHECK(joined.report.notes.empty());
  CHECK(hard_count(told) == cylinder.hard_edge_count);
  CHECK(hard_count(1e-3) == cylinder.hard_edge_count);
}

TEST_CASE("mixed orientation is counted, in one file and between files") {
  const char* quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n";
  const auto report_of = [&](const std::string& faces, NormalPolicy::Kind kind) {
    const std::string obj = quad + faces;
    ImportOptions options;
    options.normals.kind = kind;
    return import_bytes(std::as_bytes(std::span(obj)), "a.obj", options)->report;
  };
  const std::string mixed = "f 1//1 2//1 3//1\nf 1//1 4//1 3//1\n";
  const ImportReport kept = report_of(mixed, NormalPolicy::Kind::Keep);
  CHECK(kept.misoriented_edges == 1);
  CHECK(kept.reversed_normals == 1);
  CHECK(report_of(mixed, NormalPolicy::Kind::Flat).reversed_normals ==
        0);  // others than the file's
  CHECK(report_of("f 1 2 3\nf 1 3 4\n", NormalPolicy::Kind::Keep).misoriented_edges == 0);

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_mixed_orientation_test";
  std::filesystem::create_directories(folder);
  const std::vector<std::filesystem::path> paths{folder / "a.obj", folder / "b.obj"};
  std::ofstream(paths[0]) << quad << "f 1//1 2//1 3//1\n";
  std::ofstream(paths[1]) << quad << "f 1//1 4//1 3//1\n";
  const Result<Imported> both = import_meshes(paths, {});
  std::filesystem::remove_all(folder);
  REQUIRE(both.ok());
  CHECK(both->report.misoriented_edges == 1);
  CHECK(both->report.reversed_normals == 1);
}

TEST_CASE("what points up is what the format says, or what it looks like") {
  const auto up_of = [](const Mesh& mesh, const char* ending) {
    const std::vector<std::byte> bytes = *export_bytes(mesh, ending);
    const Result<Imported> in = import_bytes(bytes, std::string("a") + ending, {});
    REQUIRE(in.ok());
    CHECK(in->report.up == in->mesh.up);
    CHECK(in->report.up_is_guessed == (std::string(ending) != ".glb"));
    return in->mesh.up;
  };
  for (const char* ending : {".obj", ".ply", ".stl"}) {
    CHECK(up_of(cone(24, 6), ending) == UpAxis::Z);
  }
  CHECK(up_of(cone(24, 6), ".glb") == UpAxis::Y);
  CHECK(up_of(hard_box(2), ".obj") == UpAxis::Y);
  CHECK(up_of(hard_box(2), ".stl") == UpAxis::Z);
}

TEST_CASE("several files become one mesh with shared vertices and a part a file") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_import_test";
  std::filesystem::create_directories(folder);
  const std::vector<std::filesystem::path> paths{folder / "a.obj", folder / "b.obj",
                                                 folder / "c.off"};
  std::ofstream(paths[0]) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\nusemtl red\nf 1/1 2/1 3/1\n";
  std::ofstream(paths[1]) << "v 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl blue\nf 1 2 3\n";
  std::ofstream(paths[2]) << "OFF\n3 1 0\n1 1 0\n2 2 0\n0 1 0\n3 0 1 2\n";
  const Result<Imported> in = import_meshes(paths, {});
  REQUIRE(in.ok());
  const Mesh& mesh = in->mesh;
  CHECK(check_mesh(mesh).ok());
  CHECK(mesh.triangle_count() == 3);
  CHECK(mesh.vertex_count() == 5);
  CHECK(mesh.parts == std::vector<std::string>{"a.obj", "b.obj", "c.off"});
  CHECK(mesh.normals()->value_count() == 1);
  REQUIRE(mesh.layers.size() == 2);
  CHECK(mesh.layers[1].value_count() == 2);  // one, and zero where files have none
  REQUIRE(mesh.materials.size() == 3);
  CHECK(mesh.materials[index_of(mesh.material_of_triangle[1])].name == "blue");
  CHECK(mesh.materials[index_of(mesh.material_of_triangle[2])].name.empty());
  CHECK(in->report.format == "OBJ, OFF");
  std::filesystem::remove_all(folder);
}

TEST_CASE("files beside each other keep colours and parts, and say where they disagree") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_import_beside_test";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* name, std::uint32_t dimension, bool has_parts) {
    Mesh mesh = hard_box(1);
    if (dimension > 0) {
      AttributeLayer& color = mesh.layers.emplace_back();
      color.name = "color";
      color.role = AttributeRole::Color;
      color.dimension = dimension;
      color.values.assign(dimension, 0.5f);
      color.of_corner.assign(3 * mesh.triangle_count(), AttributeId{0});
    }
    if (has_parts) {
      mesh.parts = {"left", "right"};
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        mesh.part_of_triangle.push_back(PartId{t % 2});
      }
    }
    REQUIRE(export_mesh(mesh, folder / name).ok());
    return folder / name;
  };
  const std::vector<std::filesystem::path> paths{write("a.glb", 0, false), write("b.glb", 3, true),
                                                 write("c.ply", 4, false),
                                                 write("d.stl", 0, false)};
  std::ofstream(folder / "e.city.json")
      << R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
      << R"("vertices":[[0,0,0],[9,0,0],[0,9,0]],"CityObjects":{"x":{"type":"Building","geometry":)"
      << R"([{"type":"MultiSurface","lod":"1","boundaries":[[[0,1,2]]]}]}}})";
  for (const bool is_turned : {false, true}) {
    std::vector<std::filesystem::path> some = paths;
    some.push_back(folder / "e.city.json");
    if (is_turned) std::ranges::reverse(some);
    const Result<Imported> in = import_meshes(some, {});
    REQUIRE_MESSAGE(in.ok(), (in.ok() ? "" : in.failure().message));
    const Mesh& mesh = in->mesh;
    CHECK(check_mesh(mesh).ok());
    const auto colors = std::ranges::find(mesh.layers, AttributeRole::Color, &AttributeLayer::role);
    REQUIRE(colors != mesh.layers.end());
    CHECK(std::ranges::count(mesh.layers, AttributeRole::Color, &AttributeLayer::role) == 1);
    CHECK(colors->dimension == 4);
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const std::string& part = mesh.parts[index_of(mesh.part_of_triangle[t])];
      const std::span<const float> color = colors->value(colors->of_corner[3 * t]);
      const bool is_colored = part.starts_with("b.glb") || part.starts_with("c.ply");
      CHECK(color[0] == doctest::Approx(is_colored ? 0.5 : 1).epsilon(0.01));
      CHECK(color[3] == doctest::Approx(part == "c.ply" ? 0.5 : 1).epsilon(0.01));
    }
    for (const char* part : {"a.glb", "b.glb/left", "b.glb/right", "d.stl"}) {
      CHECK(std::ranges::count(mesh.parts, part) == 1);
    }
    const std::string note =
        is_turned ? "a.glb: says that y is up, files before it that z is; none is turned"
                  : "e.city.json: says that z is up, files before it that y is; none is turned";
    CHECK(std::ranges::any_of(in->report.notes,
                              [&](const std::string& n) { return n.ends_with(note); }));
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("noise on corner normals goes when it is asked to") {
  // A box whose corner normals are off by up to half a degree, split as exporters do it.
  std::string obj;
  const PolygonModel cube = polygon_cube();
  std::string faces;
  int count = 0;
  for (const PolygonModel::Face& face : cube.faces) {
    faces += "f";
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3d& p = cube.positions[face.corners[i]];
      const Vec3d& n = cube.normals[face.normals[i]];
      const double off = 0.005 * ((count % 3) - 1), other = 0.005 * ((count / 3 % 3) - 1);
      obj +=
          "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
      obj += "vn " + std::to_string(n.x + off * n.y) + " " + std::to_string(n.y + off * n.z) + " " +
             std::to_string(n.z + other * n.x) + "\n";
      ++count;
      faces += " " + std::to_string(count) + "//" + std::to_string(count);
    }
    faces += "\n";
  }
  obj += faces;
  CHECK(import_text(obj, "a.obj").mesh.normals()->value_count() > 6);
  ImportOptions options;
  options.same_normal_deg = 1;
  const Imported joined = import_text(obj, "a.obj", options);
  CHECK(joined.mesh.normals()->value_count() == 6);
  CHECK(joined.report.joined_normals > 0);
  CHECK(hard_edges(joined.mesh) == hard_edges(cube));
}

}  // namespace
}  // namespace crease
