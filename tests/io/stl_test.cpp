#include "io/byte_sink.h"
#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <algorithm>

namespace crease {
namespace {

std::string binary_stl(std::uint32_t promised, int facets, std::uint16_t attribute = 0) {
  ByteSink out;
  out.text(std::string(80, 'x'));
  out.u32(promised);
  for (int f = 0; f < facets; ++f) {
    for (int i = 0; i < 12; ++i) out.f32(i < 3 ? 0.0f : static_cast<float>((i + f) * (i + f) % 7));
    out.u16(attribute);
  }
  const std::vector<std::byte> bytes = out.take();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST_CASE("binary is told by its size") {
  const Imported in = import_text(binary_stl(2, 2), "a.stl");
  CHECK(in.report.format == "binary STL");
  CHECK(in.mesh.triangle_count() == 2);
}

TEST_CASE("a binary file that is cut off is refused, one that is too long is read") {
  CHECK(refusal_of(binary_stl(3, 2), "a.stl") ==
        "a.stl: byte 184: the header promises 3 facets, 234 bytes");
  CHECK(refusal_of(binary_stl(0xffffffff, 2), "a.stl")
            .starts_with("a.stl: byte 184: the header promises"));
  CHECK(import_text(binary_stl(1, 2), "a.stl").mesh.triangle_count() == 1);
}

TEST_CASE("a binary file that says solid is binary, cut off or too long as well") {
  const auto solid = [](std::uint32_t promised, int facets) {
    std::string bytes = binary_stl(promised, facets);
    bytes.replace(0, 12, "solid a cube");
    return bytes;
  };
  CHECK(import_text(solid(2, 2), "a.stl").report.format == "binary STL");
  CHECK(import_text(solid(2, 2) + "xy", "a.stl").report.format == "binary STL");
  CHECK(refusal_of(solid(3, 2), "a.stl") ==
        "a.stl: byte 184: the header promises 3 facets, 234 bytes");
}

TEST_CASE("a text begins with solid in any case, after blanks") {
  const std::string facet =
      " facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
  for (const char* begin : {"SOLID", "Solid", " solid", "\n\t solid", "\r\nsolid"}) {
    const Imported in = import_text(begin + (" x\n" + facet) + "endsolid\n", "a.stl");
    CHECK(in.report.format == "text STL");
    CHECK(in.mesh.triangle_count() == 1);
  }
}

TEST_CASE("attribute bytes are carried as a category") {
  const Mesh mesh = import_text(binary_stl(2, 2, 0x1234), "a.stl").mesh;
  REQUIRE(mesh.layers.size() == 2);
  CHECK(mesh.layers[1].name == "stl_attribute");
  CHECK(mesh.layers[1].interpolation == Interpolation::Categorical);
  CHECK(mesh.layers[1].values == std::vector<float>{0x1234});
}

TEST_CASE("attribute bytes are colours where the header says so") {
  std::string bytes = binary_stl(2, 2, 31 << 10 | 31);  // red and blue
  bytes.replace(30, 10, std::string("COLOR=\0\xff\0\xff", 10));
  bytes[84 + 50 + 49] = static_cast<char>(0x80);  // of the second: not its own
  const Mesh mesh = import_text(bytes, "a.stl").mesh;
  REQUIRE(mesh.layers.size() == 2);
  const AttributeLayer& colors = mesh.layers[1];
  CHECK(colors.role == AttributeRole::Color);
  const auto of_triangle = [&](std::size_t t) {
    const auto value = colors.value(colors.of_corner[3 * t]);
    return std::vector<float>(value.begin(), value.end());
  };
  CHECK(of_triangle(0) == std::vector<float>{1, 0, 1});
  CHECK(of_triangle(1) == std::vector<float>{0, 1, 0});
}

TEST_CASE("where no facet has a colour of its own all have the header's") {
  std::string bytes = binary_stl(2, 2, 0);
  bytes.replace(30, 10, std::string("COLOR=\x7f\x7f\x7f\xff", 10));
  const Imported in = import_text(bytes, "a.stl");
  REQUIRE(in.mesh.layers.size() == 2);
  CHECK(in.mesh.layers[1].values == std::vector<float>(3, 127 / 255.0F));
  CHECK(std::ranges::count(in.report.notes, "all of the colour that its header has") == 1);
}

TEST_CASE("an end may stand apart from what ends") {
  const std::string text =
      "solid a\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n"
      " end loop\n END facet\nend solid\n";
  CHECK(import_text(text, "a.stl").mesh.triangle_count() == 1);
  CHECK(refusal_of(text + "end of file\n", "a.stl").find("not a word of STL: 'endof'") !=
        std::string::npos);
}

TEST_CASE("several solids in a text are parts; case and layout do not matter") {
  const std::string facet =
      "FACET NORMAL 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop ENDFACET\n";
  const Mesh mesh = import_text("solid first one\n" + facet + "endsolid first one\nsolid second\n" +
                                    facet + "endsolid\n",
                                "a.stl")
                        .mesh;
  CHECK(mesh.parts == std::vector<std::string>{"first one", "second"});
  CHECK(mesh.vertex_count() == 3);
}

TEST_CASE("the only solid of a text is a part if it has a name") {
  const std::string facet =
      "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n";
  const auto parts = [&](const std::string& solid) {
    return import_text(solid + "\n" + facet + "endsolid\n", "a.stl").mesh.parts;
  };
  CHECK(parts("solid left wheel") == std::vector<std::string>{"left wheel"});
  CHECK(parts("solid").empty());
}

TEST_CASE("every refusal names the line and the reason") {
  CHECK(refusal_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "a.stl") ==
        "a.stl:4: vertex: not a number: ''");
  CHECK(refusal_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", "a.stl") ==
        "a.stl:4: vertex is not finite");
  CHECK(refusal_of("solid a\nfacet normal 0 0 1\nendfacet\n", "a.stl") ==
        "a.stl:3: a facet without three vertices");
  CHECK(refusal_of("solid a\nfacet normal 0 0 1\n", "a.stl") ==
        "a.stl:2: the file ends inside a solid");
  CHECK(refusal_of("hello\n", "a.stl") == "a.stl:1: not a word of STL: 'hello'");
}

}  // namespace
}  // namespace crease
