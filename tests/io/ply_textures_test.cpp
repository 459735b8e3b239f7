#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace crease {
namespace {

TEST_CASE("texture coordinates as vertices of their own, and textures, for each face") {
  const std::string head =
      "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n"
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 2\nproperty list uchar int vertex_indices\n"
      "element multi_texture_vertex 4\nproperty uchar tx\nproperty float u\nproperty float v\n";
  const std::string faces =
      "element multi_texture_face 2\nproperty uchar tx\nproperty uint tn\n"
      "property list uchar int texture_vertex_indices\n";
  const std::string rows =
      "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"
      "0 0 0\n1 0.5 0\n0 0.5 0.25\n0 1 1\n";
  const Imported in = import_text(head + faces + rows + "1 1 3 0 1 2\n0 0 3 3 2 1\n", "a.ply");
  REQUIRE(in.mesh.triangle_count() == 2);
  const AttributeLayer& uv = *std::ranges::find(in.mesh.layers, "uv", &AttributeLayer::name);
  CHECK(uv.value(uv.of_corner[0])[0] == 1);  // the second row is the first face's
  CHECK(uv.value(uv.of_corner[1])[1] == 0.25f);
  CHECK(uv.value(uv.of_corner[3])[0] == 0);
  CHECK(uv.value(uv.of_corner[4])[0] == 0.5f);
  REQUIRE(in.mesh.materials.size() == 2);
  const auto texture_of = [&](std::size_t triangle) {
    return in.mesh.materials[index_of(in.mesh.material_of_triangle[triangle])].base_color_texture;
  };
  CHECK(texture_of(0) == "a.png");
  CHECK(texture_of(1) == "b.png");

  const Imported without = import_text(head + rows, "a.ply");
  CHECK(std::ranges::find(without.mesh.layers, "uv", &AttributeLayer::name) ==
        without.mesh.layers.end());
  CHECK(without.report.notes == std::vector<std::string>{"element 'multi_texture_vertex' ignored"});
  const Imported beyond = import_text(head + faces + rows + "0 0 3 0 1 9\n0 7 3 0 1 2\n", "a.ply");
  CHECK(beyond.report.notes == std::vector<std::string>{"4 corners without a value in 'uv': zero"});
}

TEST_CASE("a face without a texture has none, whichever others have") {
  for (const bool is_one : {true, false}) {
    const std::string text =
        std::string("ply\nformat ascii 1.0\ncomment TextureFile a.png\n") +
        (is_one ? "" : "comment TextureFile b.png\n") +
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "property float s\nproperty float t\nelement face 2\n"
        "property list uchar int vertex_indices\nproperty int texnumber\nend_header\n"
        "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n3 0 1 2 0\n3 0 2 3 -1\n";
    const Mesh mesh = import_text(text, "a.ply").mesh;
    REQUIRE(mesh.material_of_triangle.size() == 2);
    const auto texture_of = [&](std::size_t triangle) {
      return mesh.materials[index_of(mesh.material_of_triangle[triangle])].base_color_texture;
    };
    CHECK(texture_of(0) == "a.png");
    CHECK(texture_of(1).empty());
  }
}

}  // namespace
}  // namespace crease
