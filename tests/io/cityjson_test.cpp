#include "crease/import.h"
#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace crease {
namespace {

Imported import_file(const std::string& name) {
  const Result<Imported> in = import_mesh(std::filesystem::path(CREASE_TEST_DATA) / name, {});
  REQUIRE_MESSAGE(in.ok(), (in.ok() ? "" : in.failure().message));
  CHECK(check_mesh(in->mesh).ok());
  return *in;
}

std::string material_at(const Mesh& mesh, std::size_t t) {
  return mesh.materials[index_of(mesh.material_of_triangle[t])].name;
}

double area(const Mesh& mesh, std::size_t t) {
  const auto at = [&](std::size_t c) { return mesh.positions[index_of(mesh.triangles[t][c])]; };
  return length(cross(at(1) - at(0), at(2) - at(0))) / 2;
}

double area_of(const Mesh& mesh, const std::string& material) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (material_at(mesh, t) == material) sum += area(mesh, t);
  }
  return sum;
}

// Volume by the divergence theorem: right only if the mesh is closed and faces outwards.
double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const auto at = [&](std::size_t c) {
      return mesh.positions[index_of(t[c])] - mesh.positions[0];
    };
    sum += dot(at(0), cross(at(1), at(2))) / 6;
  }
  return sum;
}

bool every_triangle_has_its_own_normal(const Mesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto at = [&](std::size_t c) { return mesh.positions[index_of(mesh.triangles[t][c])]; };
    const Vec3d geometric = normalized(cross(at(1) - at(0), at(2) - at(0)));
    for (std::size_t c = 0; c < 3; ++c) {
      const auto n = mesh.normals()->value(mesh.normals()->of_corner[3 * t + c]);
      if (dot(geometric, Vec3d{n[0], n[1], n[2]}) < 0.999999) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("CityJSON: a solid building with semantics") {
  const Imported in = import_file("cube.city.json");
  const Mesh& mesh = in.mesh;
  CHECK(in.report.format == "CityJSON 1.1");
  CHECK(in.report.polygons == 6);
  CHECK(mesh.vertex_count() == 8);
  CHECK(mesh.triangle_count() == 12);
  CHECK(hard_edges(mesh).size() == 12);
  CHECK(every_triangle_has_its_own_normal(mesh));
  CHECK(volume(mesh) == doctest::Approx(1000));
  CHECK(area_of(mesh, "RoofSurface") == doctest::Approx(100));
  CHECK(area_of(mesh, "WallSurface") == doctest::Approx(400));
  const auto layer = std::ranges::find(mesh.layers, "semantic_surface", &AttributeLayer::name);
  REQUIRE(layer != mesh.layers.end());
  CHECK(layer->interpolation == Interpolation::Categorical);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const float value = layer->value(layer->of_corner[3 * t])[0];
    CHECK(value == float(index_of(mesh.material_of_triangle[t])));
  }
}

TEST_CASE("CityJSON: a house with a window hole, the highest level of detail only") {
  const Imported in = import_file("house.city.json");
  const Mesh& mesh = in.mesh;
  CHECK(mesh.triangle_count() == 24);
  CHECK(mesh.vertex_count() == 14);
  CHECK(every_triangle_has_its_own_normal(mesh));
  CHECK(volume(mesh) == doctest::Approx(8 * 10 * 3 + 8 * 3 / 2.0 * 10));
  CHECK(area_of(mesh, "Window") == doctest::Approx(2));
  CHECK(area_of(mesh, "RoofSurface") == doctest::Approx(2 * 5 * 10));
  CHECK(area_of(mesh, "WallSurface") == doctest::Approx(2 * (8 * 3 + 12) - 2 + 30));
  CHECK(area_of(mesh, "Building") == doctest::Approx(30));  // the wall without semantics
  CHECK(mesh.parts == std::vector<std::string>{"house", "house-roof"});
  CHECK(in.report.notes.size() == 2);  // a lower level of detail, a geometry of points
}

TEST_CASE("CityJSON: quantized vertices far from the origin keep every digit") {
  const Imported in = import_file("far_block.city.json");
  CHECK(in.report.format == "CityJSON 1.0");
  CHECK(in.mesh.triangle_count() == 12);
  std::set<double> x;
  for (const Vec3d& p : in.mesh.positions) x.insert(p.x);
  CHECK(x == std::set<double>{1 * 0.001 + 389000.123, 12346 * 0.001 + 389000.123});
  CHECK(volume(in.mesh) == doctest::Approx(12.345 * 23.456 * 9.877));
  CHECK(in.mesh.materials.size() == 1);
  CHECK(in.mesh.materials[0].name == "Building");
}

TEST_CASE("CityJSON: templates stand where their instances say") {
  const Imported in = import_file("templates.city.json");
  const Mesh& mesh = in.mesh;
  CHECK(mesh.triangle_count() == 8);
  CHECK(mesh.vertex_count() == 8);
  CHECK(volume(mesh) == doctest::Approx(2 * 2 * 2 * 3 / 6.0));
  double top = 0, right = 0;
  for (const Vec3d& p : mesh.positions) {
    top = std::max(top, p.z);
    right = std::max(right, p.x);
  }
  CHECK(top == 5);
  CHECK(right == 112);
  CHECK(mesh.parts == std::vector<std::string>{"tree-0", "tree-1"});
}

TEST_CASE("CityJSON: a template that is mirrored faces outwards still") {
  const std::filesystem::path path =
      std::filesystem::path(CREASE_TEST_DATA) / "templates.city.json";
  std::ifstream file(path);
  nlohmann::json city = nlohmann::json::parse(file);
  for (auto& object : city["CityObjects"]) {
    for (auto& geometry : object["geometry"]) {
      if (geometry.contains("transformationMatrix")) geometry["transformationMatrix"][0] = -2;
    }
  }
  const Mesh mesh = import_text(city.dump(), "a.city.json").mesh;
  CHECK(mesh.triangle_count() == 8);
  CHECK(volume(mesh) > 0);
}

TEST_CASE("CityJSONSeq: features have vertices of their own and share the transform") {
  const Imported in = import_file("sequence.city.jsonl");
  CHECK(in.mesh.triangle_count() == 36);
  CHECK(in.mesh.vertex_count() == 24);
  CHECK(in.mesh.parts == std::vector<std::string>{"block-0", "block-1", "block-2"});
  CHECK(volume(in.mesh) == doctest::Approx(3));
  CHECK(std::ranges::min(in.mesh.positions, {}, &Vec3d::x).x == 10);
  CHECK(std::ranges::max(in.mesh.positions, {}, &Vec3d::x).x == doctest::Approx(17));
}

TEST_CASE("CityJSON: what cannot be meant is refused, with its place") {
  const auto object = [](const std::string& geometry) {
    return R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},)"
           R"("vertices":[[0,0,0],[1,0,0],[0,1,0]],"CityObjects":{"a":{"type":"Building","geometry":[)" +
           geometry + "]}}}";
  };
  const auto place_in = [](const std::string& text, const char* place) {
    const std::string message = refusal_of(text, "bad.city.json");
    CAPTURE(message);
    CHECK(message.starts_with("bad.city.json: "));
    CHECK(message.find(place) != std::string::npos);
  };
  place_in(object(R"({"type":"MultiSurface","lod":"2","boundaries":[[[0,1,3]]]})"),
           "CityObjects.'a'.geometry[0].boundaries[0][0][2]");
  place_in(object(R"({"type":"Solid","lod":"2","boundaries":[[[[0,1,-1]]]]})"),
           "CityObjects.'a'.geometry[0].boundaries[0][0][0][2]");
  place_in(object(R"({"type":"GeometryInstance","template":0,"boundaries":[0]})"), "geometry[0]");
  place_in(R"({"type":"CityJSON","version":"2.0","vertices":[[0,0]],"CityObjects":{}})",
           "vertices[0]");
  place_in(R"({"asset":{"version":"1.0"},"geometricError":9,"root":{"content":{"uri":"a.b3dm"}}})",
           "a tileset of 3D Tiles");
  place_in(R"({"type":"CityJSON","version":"0.8","vertices":[],"CityObjects":{}})", "version");
  place_in(R"({"type":"CityJSON","version":"2.0","vertices":[])", "byte 48");
  place_in(R"({"type":"CityJSON","version":"2.0","vertices":[]})", "CityObjects");
}

}  // namespace crease
