#include "io/polygon_model.h"
#include "support/described_mesh.h"

#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crease {
namespace {

TEST_CASE("comments, blank lines and counts on the first line") {
  CHECK(
      import_text("# first\n\nOFF 3 1 0 # counts\n\n0 0 0\n1 0 0 # b\n#\n0 1 0\n3 0 1 2\n", "a.off")
          .mesh.triangle_count() == 1);
  CHECK(import_text("3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off").mesh.triangle_count() == 1);
}

TEST_CASE("normals, colours and texture coordinates of vertices") {
  const Mesh mesh = import_text(
                        "STCNOFF\n3 1 0\n"
                        "0 0 0 0 0.6 0.8 255 0 0 255 0 0\n"
                        "1 0 0 0 0.6 0.8 255 0 0 255 1 0\n"
                        "0 1 0 0 0.6 0.8 0 51 0 255 0 1\n3 0 1 2\n",
                        "a.off")
                        .mesh;
  REQUIRE(mesh.layers.size() == 3);
  CHECK(mesh.layers[0].values == std::vector<float>{0, 0.6f, 0.8f});
  CHECK(mesh.layers[1].role == AttributeRole::TexCoord);
  CHECK(mesh.layers[2].role == AttributeRole::Color);
  CHECK(mesh.layers[2].value(mesh.layers[2].of_corner[2])[1] == doctest::Approx(0.2));
}

TEST_CASE("colours of faces, as components and as an index") {
  const std::string square = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const Mesh components = import_text(square + "3 0 1 2 1 0 0\n3 0 2 3\n", "a.off").mesh;
  REQUIRE(components.layers.size() == 2);
  const AttributeLayer& color = components.layers[1];
  CHECK(color.value(color.of_corner[0])[1] == 0);
  CHECK(color.value(color.of_corner[3])[1] == 1);  // none: white
  const Mesh index = import_text(square + "3 0 1 2 5\n3 0 2 3 6\n", "a.off").mesh;
  REQUIRE(index.layers.size() == 2);
  CHECK(index.layers[1].interpolation == Interpolation::Categorical);
  CHECK(index.layers[1].value_count() == 2);
}

TEST_CASE("a face goes on in the next lines") {
  const Mesh mesh =
      import_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0\n1 # half\n2\n3\n3 0 1\n2\n",
                  "a.off")
          .mesh;
  CHECK(mesh.triangle_count() == 3);
}

TEST_CASE("colours are whole numbers up to 255 or others up to 1, each kind by the most it has") {
  const auto greens = [](const std::string& first, const std::string& second) {
    const Mesh mesh = import_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 " + first +
                                      "\n3 0 2 3 " + second + "\n",
                                  "a.off")
                          .mesh;
    REQUIRE(mesh.layers.size() == 2);
    const AttributeLayer& color = mesh.layers[1];
    return std::vector<float>{color.value(color.of_corner[0])[1],
                              color.value(color.of_corner[3])[1]};
  };
  CHECK(greens("0 255 0", "0.0 1.0 0.0") == std::vector<float>{1, 1});
  CHECK(greens("0 255 0", "0 1 0") == std::vector<float>{1, 1 / 255.0f});
  CHECK(greens("0 1 0", "1 0 1 1") == std::vector<float>{1, 0});
  CHECK(greens("0 255.0 0", "0 51.0 0 255") == std::vector<float>{1, 0.2f});
}

TEST_CASE("numbers run on over lines, up to a colour") {
  for (const char* text :
       {"OFF 4 1 0 0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3",
        "OFF\n4 1 0\n0 0 0 1 0 0\n1 1 0 0 1 0\n4 0 1\n2 3\n",
        "OFF\n4 1 0\n0 0\n0\n1 0 0\n1 1 0\n0 1 # y\n0\n4 0 1\n2 3 7\n",
        "NOFF 4 1 0\n0 0 0 0 0 1 1 0\n0 0 0 1 1 1 0 0 0 1\n0 1 0 0 0 1 4 0 1 2 3\n",
        "OFF4 1 0 # glued\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"}) {
    CAPTURE(std::string(text));
    const Imported in = import_text(text, "a.off");
    CHECK(in.mesh.positions == std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    CHECK(in.mesh.triangle_count() == 2);
    CHECK(in.report.notes.empty());
  }
  CHECK(refusal_of("OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2 0.5 0 0", "a.off") ==
        "a.off:1: vertices and faces have no lines of their own, and more numbers than the header "
        "says: '0.5'");
}

TEST_CASE("a file that is cut is refused as such, whatever its vertices hold") {
  CHECK(refusal_of("COFF\n3 2 0\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n", "a.off") ==
        "a.off:6: the file ends; face 1 of 2 expected");
  CHECK(refusal_of("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.5 0 0\n", "a.off") ==
        "a.off:6: the file ends; face 1 of 2 expected");
  CHECK(refusal_of("COFF\n3 1 0\n0 0 0 1 1 1\n1 0 0 1 1 1\n", "a.off") ==
        "a.off:4: the file ends; a vertex expected");
}

TEST_CASE("what the header says nothing of is told") {
  const auto notes = [](const std::string& text) {
    return import_text(text, "a.off").report.notes;
  };
  using Notes = std::vector<std::string>;
  const std::string three = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  CHECK(notes(three + "3 0 1 2\n\n# end\n").empty());
  CHECK(notes(three + "3 0 1 2\n3 0 2 1\n") == Notes{"lines after the last face ignored"});
  CHECK(notes(three + "3 0 1 2\nfoo bar\n") == Notes{"lines after the last face ignored"});
  CHECK(notes(three + "3 0 1 2 1 0 0 blue\n") ==
        Notes{"1 faces have more behind them than a colour: ignored"});
  CHECK(notes("OFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 0\n3 0 1 2\n") ==
        Notes{"3 vertices hold more numbers than 'OFF' says: ignored"});
  CHECK(notes("NOFF\n3 1 0\n0 0 0 0 0 1 1 0 0\n1 0 0 0 0 1 1 0 0\n0 1 0 0 0 1 1 0 0\n3 0 1 2\n") ==
        Notes{"3 vertices hold more numbers than 'NOFF' says: ignored"});
}

TEST_CASE("every refusal names the line and the reason") {
  const std::string three = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  CHECK(refusal_of(three + "3 0 1 3\n", "a.off") == "a.off:6: face index 3 of 3 vertices");
  CHECK(refusal_of(three + "4 0 1 2\n", "a.off") ==
        "a.off:6: the file ends; corner 3 of 4 of a face expected");
  CHECK(refusal_of(three + "3 0 1 x\n", "a.off") ==
        "a.off:6: corner 2 of 3 of a face: not an index: 'x'");
  CHECK(refusal_of(three, "a.off") == "a.off:5: the file ends; face 0 of 1 expected");
  CHECK(refusal_of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n", "a.off") ==
        "a.off:5: vertex 2 of 3 is not finite");
  CHECK(refusal_of("OFF BINARY\n", "a.off") ==
        "a.off: byte 11: vertices and faces of a binary OFF do not fit into the 0 bytes that are "
        "left");
  CHECK(refusal_of("4OFF\n1 1 0\n", "a.off")
            .starts_with("a.off:1: OFF of more than three dimensions"));
  CHECK(refusal_of("OFF\n353535235358 6 0\n0 0 0\n", "a.off")
            .starts_with("a.off:2: the header promises"));
  CHECK(refusal_of("OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off") ==
        "a.off:3: vertex 0 of 3 has too few numbers");
}

// A square of a triangle and a triangle that is red, and its rows as text.
struct BinarySquare {
  bool is_big_endian = true, has_colors = true;
  std::string bytes = "NOFF BINARY\n";

  void word(std::uint32_t x) {
    for (int i = 0; i < 4; ++i) {
      bytes += static_cast<char>(x >> (is_big_endian ? 24 - 8 * i : 8 * i) & 0xff);
    }
  }
  void number(float x) { word(std::bit_cast<std::uint32_t>(x)); }

  BinarySquare(bool big, bool colors) : is_big_endian(big), has_colors(colors) {
    for (std::uint32_t count : {4, 2, 5}) word(count);
    for (auto [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      for (int c : {x, y, 0, 0, 0, 1}) number(static_cast<float>(c));
    }
    for (std::uint32_t c : {3, 0, 1, 2}) word(c);
    if (has_colors) word(0);
    for (std::uint32_t c : {3, 0, 2, 3}) word(c);
    if (!has_colors) return;
    word(3);
    for (float c : {1.0f, 0.5f, 0.0f}) number(c);
  }
  static constexpr const char* kText =
      "NOFF\n4 2 5\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n3 0 2 3";
};

TEST_CASE("binary, as Geomview writes it, and as others do: in any byte order, without colours") {
  for (const bool big : {true, false}) {
    for (const bool colors : {true, false}) {
      CAPTURE(big);
      CAPTURE(colors);
      const std::string text = std::string(BinarySquare::kText) + (colors ? " 1 0.5 0.0\n" : "\n");
      const Imported in = import_text(BinarySquare(big, colors).bytes, "a.off");
      CHECK(described(in.mesh) == described(import_text(text, "a.off").mesh));
      CHECK(in.report.notes.empty());
    }
  }
}

TEST_CASE("binary: what is cut off, goes on or has no such vertex") {
  const std::string whole = BinarySquare(true, true).bytes;
  for (std::size_t size = 12; size < whole.size(); ++size) {
    const Result<Imported> in = import_bytes(
        std::as_bytes(std::span(std::string_view(whole).substr(0, size))), "a.off", {});
    REQUIRE(!in.ok());
    CHECK(in.failure().error == Error::Truncated);
  }
  CHECK(import_text(whole + "more", "a.off").report.notes ==
        std::vector<std::string>{"bytes after the last face ignored"});
  std::string wrong = whole;
  wrong[wrong.size() - 17] = 9;  // the last corner
  CHECK(refusal_of(wrong, "a.off") == "a.off: byte 140: face index 9 of 4 vertices");
}

}  // namespace
}  // namespace crease
