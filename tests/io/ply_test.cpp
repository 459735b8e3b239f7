#include "io/byte_sink.h"
#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <string>

namespace crease {
namespace {

const AttributeLayer* layer_named(const Mesh& mesh, std::string_view name) {
  for (const AttributeLayer& layer : mesh.layers) {
    if (layer.name == name) return &layer;
  }
  return nullptr;
}

std::vector<float> value_at(const AttributeLayer& layer, std::size_t corner) {
  const auto value = layer.value(layer.of_corner[corner]);
  return {value.begin(), value.end()};
}

const std::string kThreePoints = "0 0 0\n1 0 0\n0 1 0\n";
std::string header(const std::string& vertex, const std::string& face, int vertices = 3,
                   int faces = 1) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + vertex + "element face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\n" + face +
         "end_header\n";
}

// The same file in text and in both binary orders.
std::string binary_ply(bool big_endian) {
  std::string out =
      std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
      "_endian 1.0\nelement vertex 4\nproperty double x\nproperty float y\nproperty short z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 2\nproperty int region\nproperty list uchar ushort vertex_indices\n"
      "end_header\n";
  const auto add = [&](auto x) {
    auto bytes = std::bit_cast<std::array<char, sizeof x>>(x);
    if (big_endian) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
  };
  const double xs[] = {390123.001, 390124, 390124, 390123};
  const float ys[] = {0, 0.5f, 1, 1};
  for (int i = 0; i < 4; ++i) {
    add(xs[i]);
    add(ys[i]);
    add(static_cast<std::int16_t>(-i));
    for (int c = 0; c < 3; ++c) add(static_cast<std::uint8_t>(51 * i));
  }
  for (int f = 0; f < 2; ++f) {
    add(static_cast<std::int32_t>(-7 + f));
    add(std::uint8_t{3});
    for (int c : {0, 1 + f, 2 + f}) add(static_cast<std::uint16_t>(c));
  }
  return out;
}

TEST_CASE("both binary orders hold the same mesh") {
  const Mesh little = import_text(binary_ply(false), "a.ply").mesh;
  const Mesh big = import_text(binary_ply(true), "a.ply").mesh;
  CHECK(little.positions == big.positions);
  CHECK(little.triangles == big.triangles);
  CHECK(little.positions[0] == Vec3d{390123.001, 0, 0});
  CHECK(little.positions[3].z == -3);
  REQUIRE(layer_named(little, "region"));
  CHECK(layer_named(little, "region")->interpolation == Interpolation::Categorical);
  CHECK(value_at(*layer_named(little, "region"), 3) == std::vector<float>{-6});
  CHECK(value_at(*layer_named(little, "color"), 1)[0] == doctest::Approx(0.2));
}

TEST_CASE("a binary file cut anywhere is refused with the byte") {
  const std::string whole = binary_ply(false);
  for (std::size_t size = whole.find("end_header") + 11; size < whole.size(); ++size) {
    CAPTURE(size);
    const std::string message = refusal_of(std::string(whole.data(), size), "a.ply");
    CHECK(message.starts_with("a.ply: byte "));
  }
}

TEST_CASE("a header's lines end as its first, whatever bytes follow") {
  std::string binary = binary_ply(false);
  REQUIRE(binary.find("end_header\n") != std::string::npos);
  const std::size_t body = binary.find("end_header\n") + 11;
  const auto with = [&](const std::string& line_end) {
    std::string out;
    for (char c : binary.substr(0, body)) out += c == '\n' ? line_end : std::string(1, c);
    std::string bytes = binary.substr(body);
    bytes[8] = '\n';  // somewhere in y of the first vertex
    bytes[9] = '\r';
    return out + bytes;
  };
  const Mesh expected = import_text(with("\n"), "a.ply").mesh;
  for (const char* line_end : {"\r", "\r\n", "\r\r\n"}) {
    CHECK(import_text(with(line_end), "a.ply").mesh.positions == expected.positions);
  }
}

TEST_CASE("unknown properties are kept: linear per vertex, categorical per face if integer") {
  const Mesh mesh =
      import_text(header("property float heat\n", "property uchar label\nproperty float wear\n") +
                      "0 0 0 1.5\n1 0 0 2.5\n0 1 0 3.5\n3 0 1 2 9 0.25\n",
                  "a.ply")
          .mesh;
  REQUIRE(layer_named(mesh, "heat"));
  CHECK(layer_named(mesh, "heat")->interpolation == Interpolation::Linear);
  CHECK(value_at(*layer_named(mesh, "heat"), 2) == std::vector<float>{3.5f});
  REQUIRE(layer_named(mesh, "label"));
  CHECK(layer_named(mesh, "label")->interpolation == Interpolation::Categorical);
  CHECK(value_at(*layer_named(mesh, "label"), 1) == std::vector<float>{9});
  REQUIRE(layer_named(mesh, "wear"));
  CHECK(layer_named(mesh, "wear")->interpolation == Interpolation::Linear);
}

TEST_CASE(
    "whole numbers of vertices are categories where their name says so and vertices share them") {
  const auto interpolation = [](const std::string& property, bool each_its_own) {
    std::string rows;
    for (int i = 0; i < 12; ++i) {
      rows += std::to_string(i) + " " + std::to_string(i % 3) + " 0 " +
              std::to_string(each_its_own ? 7 * i : i / 6) + "\n";
    }
    std::string text = header("property " + property + "\n", "", 12, 2);
    text += rows + "3 0 1 2\n3 6 7 8\n";
    const Imported in = import_text(text, "a.ply");
    const std::string name = property.substr(property.find(' ') + 1);
    REQUIRE(layer_named(in.mesh, name.c_str()));
    return layer_named(in.mesh, name.c_str())->interpolation;
  };
  for (const char* property :
       {"int material_id", "uchar label", "ushort objectId", "int scalar_Classification",
        "uint part2", "float label", "double scalar_Classification"}) {
    CAPTURE(property);
    CHECK(interpolation(property, false) == Interpolation::Categorical);
    CHECK(interpolation(property, true) == Interpolation::Linear);
  }
  for (const char* property : {"ushort intensity", "int width", "float idle", "uchar idle"}) {
    CAPTURE(property);
    CHECK(interpolation(property, false) == Interpolation::Linear);
  }
}

TEST_CASE("numbers of vertices that are not whole are no categories, whatever their name") {
  const auto interpolation = [](const char* odd_one) {
    std::string rows;
    for (int i = 0; i < 12; ++i) {
      rows +=
          std::to_string(i) + " " + std::to_string(i % 3) + " 0 " + (i == 6 ? odd_one : "2") + "\n";
    }
    const std::string text = header("property float label\n", "", 12, 2) + rows;
    const Mesh mesh = import_text(text + "3 0 1 2\n3 6 7 8\n", "a.ply").mesh;
    REQUIRE(layer_named(mesh, "label"));
    return layer_named(mesh, "label")->interpolation;
  };
  CHECK(interpolation("1.5") == Interpolation::Linear);
  CHECK(interpolation("1") == Interpolation::Categorical);
  CHECK(interpolation("nan") == Interpolation::Categorical);  // one that is none spoils no others
}

TEST_CASE("properties that share a name stay apart, read and written") {
  // The first x is the place; the faces have an x and an nx of their own, which are neither.
  const std::string faces =
      "property float x\nproperty float nx\nproperty int heat\nproperty int heat\n";
  const std::string rows = "0 0 0 7\n1 0 0 8\n0 1 0 9\n3 0 1 2 5 6 3 4\n";
  const Mesh mesh = import_text(header("property float x\n", faces) + rows, "a.ply").mesh;
  REQUIRE(mesh.triangle_count() == 1);
  CHECK(mesh.positions[1][0] == 1);
  const auto written = export_bytes(mesh, ".ply");
  REQUIRE(written.ok());
  const auto back = import_bytes(*written, "back.ply", {});
  REQUIRE(back.ok());
  CHECK(back->mesh.positions == mesh.positions);
  std::vector<std::string> names;
  for (const AttributeLayer& layer : back->mesh.layers) names.push_back(layer.name);
  CHECK(names == std::vector<std::string>{"normal", "x", "x", "nx", "heat", "heat"});
}

TEST_CASE("layers that properties do not tell come back by our comments") {
  Mesh mesh = hard_box(2);
  const auto add = [&](AttributeLayer layer, std::uint32_t dimension, bool per_triangle) {
    layer.dimension = dimension;
    for (std::uint32_t corner = 0; corner < 3 * mesh.triangle_count(); ++corner) {
      const VertexId v = mesh.triangles[corner / 3][corner % 3];
      const std::uint32_t of = per_triangle ? corner / 3 : static_cast<std::uint32_t>(v);
      layer.of_corner.push_back(AttributeId{of});
      while (layer.values.size() < dimension * std::size_t(of + 1)) {
        const std::size_t i = layer.values.size();
        const bool is_first = i % dimension == 0;
        layer.values.push_back(layer.interpolation == Interpolation::Direction ? float(is_first)
                               : layer.interpolation == Interpolation::Categorical
                                   ? float(i)
                                   : 0.125f * float(i % 8));
      }
    }
    mesh.layers.push_back(std::move(layer));
  };
  using enum Interpolation;
  add({"uv", AttributeRole::TexCoord, Linear, 2, {}, {}}, 2, false);
  add({"uv2", AttributeRole::TexCoord, Linear, 2, {}, {}}, 2, false);
  add({"color", AttributeRole::Color, Linear, 3, {}, {}}, 3, false);
  add({"second colour", AttributeRole::Color, Linear, 4, {}, {}}, 4, false);
  add({"_BATCHID", AttributeRole::Other, Categorical, 1, {}, {}}, 1, false);  // one a vertex
  add({"tangent", AttributeRole::Other, Direction, 3, {}, {}}, 3, false);
  add({"strain of faces", AttributeRole::Other, Categorical, 1, {}, {}}, 1, true);
  const auto written = export_bytes(mesh, ".ply");
  REQUIRE(written.ok());
  const auto back = import_bytes(*written, "back.ply", {});
  REQUIRE(back.ok());
  REQUIRE(back->mesh.layers.size() == mesh.layers.size());
  for (const AttributeLayer& layer : mesh.layers) {
    CAPTURE(layer.name);
    const AttributeLayer* got = layer_named(back->mesh, layer.name.c_str());
    REQUIRE(got);
    CHECK(got->role == layer.role);
    CHECK(got->interpolation == layer.interpolation);
    CHECK(got->dimension == layer.dimension);
    for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
      CHECK(std::ranges::equal(got->value(got->of_corner[corner]),
                               layer.value(layer.of_corner[corner])));
    }
  }
}

TEST_CASE("a comment that names what is not there, or cannot be, is passed over") {
  const std::string rows = "0 0 0 7 1 2\n1 0 0 8 1 2\n0 1 0 9 1 2\n3 0 1 2\n";
  for (const char* comment :
       {"vertex x 3 other linear place", "vertex heat 4 other linear wide",
        "vertex none 1 other linear n", "face heat 1 other linear n",
        "vertex heat 0 other linear n", "vertex heat 2 color linear n",
        "vertex heat 2 other direction n", "vertex heat 1 normal linear n", "vertex heat", ""}) {
    CAPTURE(comment);
    const std::string text = header(
        std::string("property float heat\nproperty float b\nproperty float c\ncomment layer ") +
            comment + "\n",
        "");
    const Mesh mesh = import_text(text + rows, "a.ply").mesh;
    CHECK(mesh.positions.size() == 3);
    REQUIRE(layer_named(mesh, "heat"));
    CHECK(layer_named(mesh, "heat")->dimension == 1);
  }
}

TEST_CASE("texture coordinates under every usual name") {
  for (const char* names : {"s t", "u v", "texture_u texture_v", "texture_s texture_t"}) {
    CAPTURE(names);
    const std::string both(names);
    const std::size_t blank = both.find(' ');
    const std::string properties = "property float " + both.substr(0, blank) + "\nproperty float " +
                                   both.substr(blank + 1) + "\n";
    const Mesh mesh =
        import_text(header(properties, "") + "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n", "a.ply")
            .mesh;
    REQUIRE(layer_named(mesh, "uv"));
    CHECK(layer_named(mesh, "uv")->role == AttributeRole::TexCoord);
    CHECK(value_at(*layer_named(mesh, "uv"), 2) == std::vector<float>{0, 1});
  }
}

TEST_CASE("texture coordinates per corner make seams, and the texture becomes the material") {
  const Mesh mesh =
      import_text(
          "ply\nformat ascii 1.0\ncomment TextureFile my skin.png\nelement vertex 4\nproperty "
          "float x\n"
          "property float y\nproperty float z\nelement face 2\nproperty list uchar int "
          "vertex_indices\n"
          "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
          "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0.5 1 1 0 1\n",
          "a.ply")
          .mesh;
  const AttributeLayer* uv = layer_named(mesh, "uv");
  REQUIRE(uv);
  CHECK(uv->of_corner[0] != uv->of_corner[3]);
  CHECK(uv->of_corner[2] == uv->of_corner[4]);
  REQUIRE(mesh.materials.size() == 1);
  CHECK(mesh.materials[0].base_color_texture == "my skin.png");
}

TEST_CASE("normals of faces are used where vertices have none") {
  const Mesh mesh =
      import_text(header("", "property float nx\nproperty float ny\nproperty float nz\n") +
                      kThreePoints + "3 0 1 2 0 0.6 0.8\n",
                  "a.ply")
          .mesh;
  CHECK(value_at(*mesh.normals(), 1) == std::vector<float>{0, 0.6f, 0.8f});
}

TEST_CASE("normals in bytes, with signs and without") {
  const auto normal_of = [](const std::string& type, const std::string& values) {
    const std::string properties =
        "property " + type + " nx\nproperty " + type + " ny\nproperty " + type + " nz\n";
    const Mesh mesh =
        import_text(header("", properties) + kThreePoints + "3 0 1 2 " + values + "\n", "a.ply")
            .mesh;
    return value_at(*mesh.normals(), 1);
  };
  using Case = std::pair<std::string, std::string>;
  for (const Case& c : {Case("char", "0 -128 127"),
                        {"uchar", "127 0 255"},
                        {"short", "0 -32768 32767"},
                        {"ushort", "32767 0 65535"}}) {
    CAPTURE(c.first);
    const std::vector<float> n = normal_of(c.first, c.second);
    CHECK(n[0] == doctest::Approx(0).epsilon(0.01));
    CHECK(n[1] == doctest::Approx(-0.7071).epsilon(0.01));
    CHECK(n[2] == doctest::Approx(0.7071).epsilon(0.01));
  }
}

TEST_CASE("triangle strips turn every other triangle and break at -1") {
  const Mesh mesh = import_text(
                        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float "
                        "y\nproperty float z\n"
                        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 2 0\n8 0 1 2 3 -1 3 1 4\n",
                        "a.ply")
                        .mesh;
  REQUIRE(mesh.triangle_count() == 3);
  for (std::size_t t = 0; t < 2; ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    const Vec3d& p = mesh.positions[index_of(a)];
    CHECK(cross(mesh.positions[index_of(b)] - p, mesh.positions[index_of(c)] - p).z > 0);
  }
}

TEST_CASE("of several lists of strips the indices are read") {
  const Imported in = import_text(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int other\n"
      "property list int int vertex_index\nproperty int color\nend_header\n"
      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 99 4 0 1 3 2 7\n",
      "a.ply");
  CHECK(in.mesh.triangle_count() == 2);
  CHECK(in.report.notes == std::vector<std::string>{"'other' of 'tristrips' ignored",
                                                    "'color' of 'tristrips' ignored"});
  CHECK(refusal_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "property float z\nelement tristrips 1\nproperty list int int other\n"
                   "end_header\n0 0 0\n1 0\n",
                   "a.ply")
            .ends_with("strips have no vertex_indices"));
}

TEST_CASE("unknown elements and lists are passed over") {
  const Imported in = import_text(
      "ply\nformat ascii 1.0\nelement camera 1\nproperty float focus\nproperty list uchar float k\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty list uchar "
      "int ring\n"
      "element face 1\nproperty list uchar int vertex_index\nend_header\n"
      "35 2 1 1\n0 0 0 0\n1 0 0 1 5\n0 1 0 0\n\n3 0 1 2\n",
      "a.ply");
  CHECK(in.mesh.triangle_count() == 1);
  CHECK(in.report.notes.size() == 2);
}

TEST_CASE("a line of the header that says nothing is passed over and told") {
  std::string text = header("", "") + kThreePoints + "3 0 1 2\n";
  text.insert(text.find("element"), "Created by Blender3D 247\n");
  const Imported read = import_text(text, "a.ply");
  CHECK(read.mesh.triangle_count() == 1);
  REQUIRE(read.report.notes.size() == 1);
  CHECK(read.report.notes[0] == "line of the header ignored that begins with 'Created'");
}

TEST_CASE("rows that hold more than the header says keep what is certain") {
  const Imported in =
      import_text(header("", "property uchar red\nproperty uchar green\nproperty uchar blue\n") +
                      kThreePoints + "3 0 1 2 9 1 1 1 1 1\n",
                  "a.ply");
  CHECK(in.mesh.triangle_count() == 1);
  CHECK(layer_named(in.mesh, "color") == nullptr);
  CHECK(in.report.notes.size() == 1);
}

TEST_CASE("rows of an element that is ignored say nothing of the next one") {
  std::string text =
      header("property float heat\n", "") + "1 2\n0 0 0 5\n1 0 0 5\n0 1 0 5\n3 0 1 2\n";
  text.insert(text.find("element vertex"), "element camera 1\nproperty float focus\n");
  const Imported in = import_text(text, "a.ply");
  CHECK(layer_named(in.mesh, "heat") != nullptr);
  CHECK(in.report.notes == std::vector<std::string>{"element 'camera' ignored"});
}

TEST_CASE("what follows the last row is told") {
  using Notes = std::vector<std::string>;
  const std::string text = header("", "") + kThreePoints + "3 0 1 2\n";
  CHECK(import_text(text + "\n \n", "a.ply").report.notes.empty());
  CHECK(import_text(text + "3 0 2 1\n", "a.ply").report.notes ==
        Notes{"lines after the last row ignored"});
  CHECK(import_text(binary_ply(true), "a.ply").report.notes.empty());
  CHECK(import_text(binary_ply(true) + "x", "a.ply").report.notes ==
        Notes{"bytes after the last row ignored"});
}

TEST_CASE("colours in floats, in shorts and per face") {
  const std::string three = "property float red\nproperty float green\nproperty float blue\n";
  const Mesh floats =
      import_text(header(three, "") + "0 0 0 0 0 1\n1 0 0 0.5 0 1\n0 1 0 0 0 1\n3 0 1 2\n", "a.ply")
          .mesh;
  CHECK(value_at(*layer_named(floats, "color"), 1) == std::vector<float>{0.5f, 0, 1});
  const std::string shorts = "property ushort red\nproperty ushort green\nproperty ushort blue\n";
  const Mesh faces =
      import_text(header("", shorts) + kThreePoints + "3 0 1 2 65535 0 65535\n", "a.ply").mesh;
  CHECK(value_at(*layer_named(faces, "color"), 1) == std::vector<float>{1, 0, 1});
}

TEST_CASE("every refusal names the place and the reason") {
  CHECK(refusal_of("plx\n", "a.ply") == "a.ply:1: does not begin with 'ply'");
  CHECK(refusal_of("ply\nformat ascii 1.0\n", "a.ply") == "a.ply:2: the header has no end_header");
  CHECK(refusal_of("ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nend_header\n",
                   "a.ply") == "a.ply:4: unknown property type 'quad'");
  CHECK(refusal_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
                   "a.ply")
            .find("vertices have no y") != std::string::npos);
  CHECK(refusal_of(header("", "") + kThreePoints + "3 0 1 3\n", "a.ply") ==
        "a.ply:13: vertex index 3 of 3 vertices");
  CHECK(refusal_of(header("", "") + kThreePoints + "3 0 1 -1\n", "a.ply") ==
        "a.ply:13: vertex index -1 of 3 vertices");
  std::string floats = header("", "") + kThreePoints + "3 0.0 1e0 1.5\n";
  floats.replace(floats.find("uchar int"), 9, "int float");
  CHECK(refusal_of(floats, "a.ply") == "a.ply:13: vertex index 1.5 is no whole number");
  floats.replace(floats.find("1.5"), 3, "2.0");
  CHECK(import_text(floats, "a.ply").mesh.triangle_count() == 1);
  CHECK(refusal_of(header("", "") + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "a.ply") ==
        "a.ply:11: vertex 1 is not finite");
  CHECK(refusal_of("ply\nformat ascii 1.0\nelement face 1\n"
                   "property list uchar int vertex_indices\nelement vertex 3\nproperty float x\n"
                   "property float y\nproperty float z\nend_header\n3 0 1 2\n" +
                       std::string(kThreePoints),
                   "a.ply")
            .find("'face' comes before the vertices it names") != std::string::npos);
  CHECK(refusal_of(header("", "") + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "a.ply") ==
        "a.ply:11: vertex 1 of 3 has too few numbers");
  CHECK(refusal_of(header("", "") + kThreePoints + "3 0 1 x\n", "a.ply") ==
        "a.ply:13: face 0 of 1: not a number: 'x'");
}

TEST_CASE("an element that the header names twice is refused") {
  const std::string twice =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float heat\nelement vertex 0\nproperty float x\n"
      "property float y\nproperty float z\nproperty float heat\nend_header\n0 0 0 1\n";
  CHECK(refusal_of(twice, "a.ply") == "a.ply:8: a second element 'vertex'");
}

TEST_CASE("counts beyond the file's size take no memory") {
  for (const char* count : {"4294967295", "9223372036854775807", "1000000000000"}) {
    const std::string huge =
        std::string("ply\nformat binary_little_endian 1.0\nelement vertex ") + count +
        "\nproperty float x\nproperty float y\nproperty float z\nend_header\nabc";
    CHECK(refusal_of(huge, "a.ply").find("promises") != std::string::npos);
  }
  const std::string list =
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uint int vertex_indices\nend_header\n\xff\xff\xff\x7f";
  CHECK(refusal_of(list, "a.ply").find("a list longer than the file") != std::string::npos);
}

TEST_CASE("numbers that are no floats are rounded and told") {
  const Imported in = import_text(
      header(
          "property double quality\nproperty double nx\nproperty double ny\nproperty double nz\n",
          "property int id\nproperty double time\n") +
          "0 0 0 0.5 0 0.6 0.8\n1 0 0 0.25 0 0.6 0.8\n0 1 0 1e300 0 0.6 0.8\n"
          "3 0 1 2 123456789 1500000000.123\n",
      "a.ply");
  const auto told = [&](const char* note) {
    return std::ranges::count(in.report.notes, std::string(note)) == 1;
  };
  CHECK(told("1 values of 'id' rounded to floats, by 3 at most"));
  CHECK(told("1 values of 'time' rounded to floats, by 0.123 at most"));
  CHECK(told("'quality' has 1 value that is not finite: set to zero"));
  CHECK(in.report.notes.size() == 3);  // 0.5 is a float, and normals have their own precision

  // What the file says are floats is none the less for being written in decimals.
  const Imported decimals =
      import_text(header("property float quality\n", "property float32 heat\n") +
                      "0 0 0 0.1\n1 0 0 0.2\n0 1 0 0.3\n3 0 1 2 0.7\n",
                  "a.ply");
  CHECK(decimals.report.notes.empty());
  CHECK(in.report.bad_attribute_values == 1);
  CHECK(value_at(*layer_named(in.mesh, "id"), 0)[0] == 123456792.0f);
}

}  // namespace
}  // namespace crease
