// What each exporter writes, its importer reads back: positions, triangles, hard edges, colours,
// texture coordinates. STL holds less and is checked for that.
#include "crease/export.h"
#include "io/polygon_model.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace crease {
namespace {

// A mesh as a sorted list of triangles, each with all that its corners carry, from its least corner
// on: independent of the order of vertices and values.
using Corner = std::vector<double>;
using Corners = std::array<Corner, 3>;
std::vector<Corners> content(const Mesh& mesh, bool in_floats) {
  std::vector<Corners> out;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    Corners corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d& p = mesh.positions[index_of(mesh.triangles[t][c])];
      for (int i = 0; i < 3; ++i) {
        corners[c].push_back(in_floats ? static_cast<double>(static_cast<float>(p[i])) + 0.0
                                       : p[i] + 0.0);
      }
      for (const AttributeLayer& layer : mesh.layers) {
        for (float x : layer.value(layer.of_corner[3 * t + c]))
          corners[c].push_back(static_cast<double>(x));
      }
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    out.push_back(corners);
  }
  std::sort(out.begin(), out.end());
  return out;
}

Imported back(const Mesh& mesh, const std::string& extension) {
  const Result<std::vector<std::byte>> bytes = export_bytes(mesh, extension);
  REQUIRE(bytes.ok());
  Result<Imported> in = import_bytes(*bytes, "model" + extension, {});
  REQUIRE(in.ok());
  CHECK(check_mesh(in->mesh).ok());
  return std::move(*in);
}

// Vertices at one position are one after import, and normals of one value: the zoo has some that
// are not, so it goes through once before it is compared.
Mesh settled(const Mesh& mesh) {
  return back(mesh, ".ply").mesh;
}

// A square with a seam in its texture coordinates and two colours at one vertex.
Mesh coloured_square() {
  return import_text(
             "v 0 0 0 1 0 0\nv 1 0 0 0 0.2 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nv 0 0 0 0 1 0\n"
             "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.25 0.125\nvn 0 0 1\nvn 0.6 0 0.8\n"
             "o first\nusemtl red\nf 1/1/1 2/2/1 3/3/1\no second\nusemtl blue\nf 5/5/2 3/3/1 "
             "4/4/1\n",
             "a.obj")
      .mesh;
}

TEST_CASE("OBJ and PLY give back every corner of the zoo") {
  for (const ZooMesh& z : mesh_zoo()) {
    if (z.mesh.triangle_count() == 0) continue;
    CAPTURE(z.name);
    const Mesh mesh = settled(z.mesh);
    for (const char* extension : {".obj", ".ply"}) {
      const bool holds_all = std::string_view(extension) == ".ply";
      CAPTURE(extension);
      Mesh expected = mesh;
      if (!holds_all) {
        // OBJ has no place for more than normals, texture coordinates and three colour components.
        std::erase_if(expected.layers, [](const AttributeLayer& layer) {
          return layer.role == AttributeRole::Other || layer.dimension == 4;
        });
        if (expected.layers.size() != mesh.layers.size()) continue;
      }
      const Mesh got = back(expected, extension).mesh;
      CHECK(got.vertex_count() == expected.vertex_count());
      if (got.layers.size() == expected.layers.size()) {
        CHECK(content(got, false) == content(expected, false));
      }
      CHECK(hard_edges(got) == hard_edges(expected));
    }
  }
}

TEST_CASE("colours, texture coordinates and materials come back") {
  const Mesh mesh = coloured_square();
  for (const char* extension : {".obj", ".ply"}) {
    CAPTURE(extension);
    const Mesh got = back(mesh, extension).mesh;
    CHECK(got.layers.size() == 3);
    for (const AttributeLayer& layer : mesh.layers) {
      const auto same = std::find_if(got.layers.begin(), got.layers.end(),
                                     [&](const auto& other) { return other.role == layer.role; });
      REQUIRE(same != got.layers.end());
      for (std::size_t corner = 0; corner < 6; ++corner) {
        const auto a = layer.value(layer.of_corner[corner]),
                   b = same->value(same->of_corner[corner]);
        CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end()));
      }
    }
    REQUIRE(got.materials.size() == 2);
    CHECK(got.materials[index_of(got.material_of_triangle[0])].name == "red");
    CHECK(got.materials[index_of(got.material_of_triangle[1])].name == "blue");
  }
  for (const char* extension : {".obj", ".ply", ".glb"}) {
    CHECK(back(mesh, extension).mesh.parts == std::vector<std::string>{"first", "second"});
  }
}

TEST_CASE("OBJ and PLY say in a comment what is up, where it is known") {
  for (const char* ending : {".obj", ".ply"}) {
    CAPTURE(std::string(ending));
    Mesh mesh = cone(24, 6);  // stands along z
    for (const UpAxis up : {UpAxis::Y, UpAxis::Z, UpAxis::Unknown}) {
      mesh.up = up;
      const Result<std::vector<std::byte>> bytes = export_bytes(mesh, ending);
      REQUIRE(bytes.ok());
      const Result<Imported> in = import_bytes(*bytes, std::string("a") + ending, {});
      REQUIRE(in.ok());
      CHECK(in->mesh.up == (up == UpAxis::Unknown ? UpAxis::Z : up));
      CHECK(in->report.up_is_guessed == (up == UpAxis::Unknown));
    }
  }
}

TEST_CASE("a PLY holds parts, base colours and which texture each material has") {
  Mesh mesh = coloured_square();
  mesh.parts = {"north wall", "\\ 2\nlines"};
  mesh.materials[0].base_color = {0.25f, 0.1f, 1, 0.5f};
  for (const bool has_texture : {false, true}) {
    CAPTURE(has_texture);
    if (has_texture) mesh.materials[1].base_color_texture = "bricks of 3.png";
    const Mesh got = back(mesh, ".ply").mesh;
    CHECK(got.materials == mesh.materials);
    CHECK(got.material_of_triangle == mesh.material_of_triangle);
    CHECK(got.parts == std::vector<std::string>{"north wall", "\\ 2 lines"});
    CHECK(got.part_of_triangle == mesh.part_of_triangle);
    CHECK(got.layers.size() == 3);  // no index is left over
    const std::vector<std::byte> bytes = *export_bytes(mesh, ".ply");
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    CHECK((text.find("comment TextureFile bricks of 3.png\n") != text.npos) == has_texture);
    CHECK((text.find("property int texnumber\n") != text.npos) == has_texture);
  }
  mesh.materials[0].base_color_texture = "bricks of 3.png";
  const std::vector<std::byte> bytes = *export_bytes(mesh, ".ply");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  CHECK(text.find("texnumber") == text.npos);  // the only texture is that of all
  CHECK(back(mesh, ".ply").mesh.materials == mesh.materials);
}

TEST_CASE("what has no place in a format is told") {
  using Words = std::vector<std::string>;
  Mesh mesh = coloured_square();
  CHECK(export_report(mesh, ".obj").left_out == Words{});
  CHECK(export_report(mesh, ".ply").left_out == Words{});
  CHECK(export_report(mesh, ".glb").left_out == Words{});
  CHECK(export_report(mesh, ".stl").left_out == Words{"normals", "colours 'color'",
                                                      "texture coordinates 'uv'", "materials (2)",
                                                      "parts (2)"});
  AttributeLayer heat{"heat", AttributeRole::Other, Interpolation::Linear, 1, {0.5f}, {}};
  heat.of_corner.assign(6, AttributeId{0});
  AttributeLayer second = mesh.layers[2];
  second.name = "uv2";
  mesh.layers.push_back(heat);
  mesh.layers.push_back(second);
  mesh.materials[0].base_color_texture = "bricks.png";
  CHECK(export_report(mesh, ".OBJ").left_out ==
        Words{"'heat'", "texture coordinates 'uv2'", "images that textures name (1)"});
  CHECK(export_report(mesh, ".ply").left_out == Words{"images that textures name (1)"});
  CHECK(export_report(mesh, ".glb").left_out == Words{"images that textures name (1)"});
  mesh.images.push_back({"bricks.png", std::make_shared<const std::vector<std::byte>>()});
  CHECK(export_report(mesh, ".glb").left_out == Words{});
}

TEST_CASE("attribute bytes of an STL come back") {
  Mesh mesh = hard_box(1);
  mesh.layers.push_back(
      {"stl_attribute", AttributeRole::Other, Interpolation::Categorical, 1, {0, 65535, 12}, {}});
  for (std::uint32_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    mesh.layers.back().of_corner.push_back(AttributeId{corner / 3 % 3});
  }
  CHECK(export_report(mesh, ".stl").left_out == std::vector<std::string>{"normals"});
  const Mesh got = back(mesh, ".stl").mesh;
  REQUIRE(got.layers.size() == 2);
  for (std::size_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
    const auto value = [&](const Mesh& m) {
      return m.layers[1].value(m.layers[1].of_corner[corner])[0];
    };
    CHECK(value(got) == value(mesh));
  }
  mesh.layers.back().values[1] = 65536;  // has no place there
  CHECK(export_report(mesh, ".stl").left_out.size() == 2);
  CHECK(back(mesh, ".stl").mesh.layers.size() == 1);
}

TEST_CASE(
    "categories and other layers go through PLY, and through GLB if they are short integers") {
  Mesh mesh = coloured_square();
  AttributeLayer surface{"surface", AttributeRole::Other, Interpolation::Categorical, 1, {3, -4},
                         {}};
  AttributeLayer heat{"heat", AttributeRole::Other, Interpolation::Linear, 1, {0.5f, 0.25f}, {}};
  for (std::uint32_t corner = 0; corner < 6; ++corner) {
    surface.of_corner.push_back(AttributeId{corner / 3});
    heat.of_corner.push_back(AttributeId{corner % 2});
  }
  mesh.layers.push_back(surface);
  mesh.layers.push_back(heat);
  const auto check_both = [&](const std::string& ending) {
    INFO(ending);
    const Mesh got = back(mesh, ending).mesh;
    for (const AttributeLayer& layer : {surface, heat}) {
      const auto same = std::find_if(got.layers.begin(), got.layers.end(),
                                     [&](const auto& other) { return other.name == layer.name; });
      REQUIRE(same != got.layers.end());
      CHECK(same->interpolation == layer.interpolation);
      for (std::size_t corner = 0; corner < 6; ++corner) {
        CHECK(same->value(same->of_corner[corner])[0] == layer.value(layer.of_corner[corner])[0]);
      }
    }
  };
  check_both(".ply");
  check_both(".glb");
  CHECK(export_report(mesh, ".glb").left_out.empty());
  for (const float large : {65535.0f, 70000.0f}) {
    mesh.layers[mesh.layers.size() - 2].values = surface.values = {3, large};
    check_both(".ply");
    if (large < 65536) {
      check_both(".glb");
      CHECK(export_report(mesh, ".glb").left_out.empty());
    } else {
      surface.interpolation = Interpolation::Linear;
      check_both(".glb");
      CHECK(export_report(mesh, ".glb").left_out ==
            std::vector<std::string>{"that 'surface' are categories and no plain numbers"});
    }
  }
}

TEST_CASE("STL gives back positions and triangles, and hard edges by angle") {
  for (const Mesh& mesh : {hard_box(2), hard_cylinder(24, 2)}) {
    const Mesh got = back(mesh, ".stl").mesh;
    Mesh bare = mesh, got_bare = got;
    bare.layers.clear();
    got_bare.layers.clear();
    CHECK(content(got_bare, true) == content(bare, true));
    CHECK(hard_edges(got).size() == hard_edges(mesh).size());
  }
}

TEST_CASE("positions of city size keep every bit in OBJ and PLY") {
  Mesh mesh = hard_box(1);
  for (Vec3d& p : mesh.positions) p += Vec3d{390123.0017, 5820456.0023, 34.1};
  for (const char* extension : {".obj", ".ply"}) {
    CHECK(content(back(mesh, extension).mesh, false) == content(mesh, false));
  }
}

// The largest distance of a vertex from the same one of `back`, which has `origin` added.
double moved(const Mesh& mesh, const Mesh& back, const Vec3d& origin) {
  REQUIRE(mesh.vertex_count() == back.vertex_count());
  double most = 0;
  for (const Vec3d& p : mesh.positions) {
    double nearest = 1e300;
    for (const Vec3d& q : back.positions) nearest = std::min(nearest, length(q + origin - p));
    most = std::max(most, nearest);
  }
  return most;
}

// The sums of a grid's origin and its steps are off by a rounding; what was written as 503.458 is
// 503.458 again.
TEST_CASE("an OBJ has the decimals that its positions had") {
  Mesh mesh = hard_box(8);
  const auto written = [&](double x) {
    for (Vec3d& p : mesh.positions) p = {0, 0, 0};
    mesh.positions.back() = {x, 0.001, -0.003};
    const Grid grid = make_grid(mesh, {.length = 0.001});
    snap(mesh, grid);
    const std::vector<std::byte> bytes = *export_bytes(mesh, ".obj");
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t at = text.rfind("\nv ") + 3;
    return text.substr(at, text.find('\n', at) - at);
  };
  CHECK(written(503.458) == "503.458 0.001 -0.003");
  CHECK(written(-23.1) == "-23.1 0.001 -0.003");
  CHECK(written(0.021) == "0.021 0.001 -0.003");
  CHECK(written(723456.78) == "723456.78 0.001 -0.003");
  CHECK(written(4000) == "4000 0.001 -0.003");
  // One that has none makes all of them exact.
  mesh.positions.front().x = 1.0 / 3;
  const std::vector<std::byte> bytes = *export_bytes(mesh, ".obj");
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  CHECK(text.find("v 0.3333333333333333 ") != text.npos);
}

TEST_CASE("an STL far from the origin is written less a round one, and the report says so") {
  struct Case {
    Vec3d at, origin;
  };
  const Case cases[] = {{{0, 0, 0}, {0, 0, 0}},
                        {{9, -4, 2}, {0, 0, 0}},  // as parts of machines are: where they belong
                        {{390123.0017, 5820456.0023, 1.1}, {390120, 5820460, 0}},
                        {{-5e6, 1e6, 0}, {-5e6, 1e6, 0}}};
  for (const Case& c : cases) {
    CAPTURE(c.at.x);
    Mesh mesh = hard_cylinder(24, 2);
    for (Vec3d& p : mesh.positions) p += c.at;
    const ExportReport report = export_report(mesh, ".stl");
    CHECK(report.origin == c.origin);
    CHECK(report.rounding < 4e-6);
    CHECK(report.rounding > 0);
    // Others do not read what the header says, and show it less the origin.
    std::vector<std::byte> bytes = *export_bytes(mesh, ".stl");
    CHECK(moved(mesh, back(mesh, ".stl").mesh, {}) ==
          doctest::Approx(report.rounding).epsilon(0.01));
    bytes[0] = std::byte{'B'};
    const Mesh bare = import_bytes(bytes, "a.stl", {})->mesh;
    CHECK(moved(mesh, bare, report.origin) == doctest::Approx(report.rounding).epsilon(0.01));
    const ExportReport glb = export_report(mesh, ".GLB");
    CHECK(glb.origin == Vec3d{});
    CHECK(glb.rounding < 4e-7);
    CHECK(moved(mesh, back(mesh, ".glb").mesh, {}) <= glb.rounding + 1e-9);
    CHECK(export_report(mesh, ".ply").rounding == 0);
  }
  Mesh mesh = hard_box(1);
  for (Vec3d& p : mesh.positions) p = p * 1e-7 + Vec3d{0.25, 0, 0};
  CHECK(export_report(mesh, ".stl").origin == Vec3d{0.25, 0, 0});
  for (Vec3d& p : mesh.positions) p += Vec3d{3e6, 0, 0};
  const std::vector<std::byte> bytes = *export_bytes(mesh, ".stl");
  const std::string header(reinterpret_cast<const char*>(bytes.data()), 80);
  CHECK(header.starts_with("binary STL, written by crease less 3000000.25 0 0  "));
  for (const char* text : {"less", "less 1 2", "less nan 0 0", "less 1e31 0 0", "less x 0 0"}) {
    CAPTURE(text);
    std::string other = "binary STL, written by crease " + std::string(text);
    other.resize(80, ' ');
    std::vector<std::byte> file = bytes;
    std::memcpy(file.data(), other.data(), other.size());
    const Result<Imported> in = import_bytes(file, "a.stl", {});
    const bool is_position = std::string_view(text).find("nan") == other.npos &&
                             std::string_view(text).find("1e31") == other.npos;
    CHECK(in.ok() == is_position);
    if (in.ok()) CHECK(length(in->mesh.positions[0]) < 1);
  }
}

TEST_CASE("a GLB keeps where materials have holes and two sides, others say that they do not") {
  Mesh mesh = coloured_square();
  mesh.materials[0].base_color_texture = "bricks.png";
  mesh.materials[0].alpha_cutoff = 0.25f;
  mesh.materials[1].double_sided = true;
  CHECK(back(mesh, ".glb").mesh.materials == mesh.materials);
  const std::string holes = "holes of materials by their textures' alpha (1)";
  for (const char* ending : {".obj", ".ply"}) {
    const std::vector<std::string> lost = export_report(mesh, ending).left_out;
    CHECK(std::ranges::count(lost, holes) == 1);
  }
  mesh.materials[1].is_blended = true;
  CHECK(back(mesh, ".glb").mesh.materials == mesh.materials);
  for (const char* ending : {".obj", ".ply"}) {
    const std::vector<std::string> lost = export_report(mesh, ending).left_out;
    CHECK(std::ranges::count(lost, "blending of materials (1)") == 1);
  }
}

TEST_CASE("a file appears with its material library, or not at all") {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "crease_export_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  Mesh mesh = coloured_square();
  mesh.materials[0].base_color = {0.25f, 0.5f, 1, 0.5f};
  mesh.materials[1].base_color_texture = "bricks.png";
  REQUIRE(export_mesh(mesh, folder / "level.obj").ok());
  const Result<Imported> in = import_mesh(folder / "level.obj", {});
  REQUIRE(in.ok());
  CHECK(in->mesh.materials == mesh.materials);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
  CHECK(files == 2);

  const Result<ExportReport> nowhere = export_mesh(mesh, folder / "missing" / "level.ply");
  REQUIRE(!nowhere.ok());
  CHECK(nowhere.failure().error == Error::WriteFailed);
  const Result<ExportReport> unknown = export_mesh(mesh, folder / "level.3ds");
  REQUIRE(!unknown.ok());
  CHECK(unknown.failure().error == Error::NotSupported);
  // A full device: nothing is left behind.
  if (std::filesystem::exists("/dev/full")) {
    std::filesystem::create_directory(folder / "taken.ply");
    CHECK(!export_mesh(mesh, folder / "taken.ply").ok());
    files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
    CHECK(files == 3);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace crease
