// Where joints put the vertices of a glTF.
#include "crease/import.h"
#include "io/gltf_triangle.h"
#include "io/polygon_model.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace crease {

namespace {

using Json = GltfBuilder::Json;

// The triangle at a node that is far away, and two joints: 1 at (0, 3, 0), below it 2 at (0, 3, 5).
GltfBuilder two_joints() {
  GltfBuilder b = one_triangle();
  b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                     {{"children", {2}}, {"translation", {0, 3, 0}}},
                     {{"translation", {0, 0, 5}}}};
  b.json["scenes"] = {{{"nodes", {0, 1}}}};
  b.json["skins"] = {{{"joints", {2, 1}}}};
  return b;
}

Json& attributes_of(GltfBuilder& b) {
  return b.json["meshes"][0]["primitives"][0]["attributes"];
}

// Each vertex on two joints of four.
void add_weights(GltfBuilder& b, const std::vector<std::uint8_t>& joints,
                 const std::vector<float>& weights) {
  attributes_of(b)["JOINTS_0"] = b.add(joints, "VEC4");
  attributes_of(b)["WEIGHTS_0"] = b.add(weights, "VEC4");
}

std::size_t add_matrices(GltfBuilder& b, const std::vector<float>& values) {
  return b.add_accessor({{"bufferView", b.add_view(values)},
                         {"componentType", 5126},
                         {"count", values.size() / 16},
                         {"type", "MAT4"}});
}

}  // namespace

TEST_CASE("glTF: a skinned mesh without weights stands where its first joint puts it") {
  GltfBuilder b = two_joints();
  const Imported in = import_text(b.gltf(), "a.gltf");
  CHECK(corner(in.mesh, 0, 0) == Vec3d{0, 3, 5});
  CHECK(
      has_note(in.report, "a skinned mesh taken as the joints stand, without joints and weights"));
  CHECK(has_note(in.report, "1 primitives without JOINTS_0 and WEIGHTS_0"));
  // Bound where the joint is: all is as stored. The second joint has no matrix.
  b.json["skins"][0]["inverseBindMatrices"] =
      add_matrices(b, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -3, -5, 1});
  const Imported bound = import_text(b.gltf(), "a.gltf");
  CHECK(corner(bound.mesh, 0, 0) == Vec3d{0, 0, 0});
  CHECK(has_note(bound.report, "1 joints of skins move nothing"));
  b.json["skins"][0]["joints"] = {9};
  CHECK(corner(import_text(b.gltf(), "a.gltf").mesh, 0, 0) == Vec3d{0, 0, 0});
}

TEST_CASE("glTF: the joints of a vertex move it by their weights, whatever others do") {
  GltfBuilder b = two_joints();
  b.json["nodes"][2]["scale"] = {2, 2, 2};
  b.json["nodes"].push_back({{"scale", {1000, 1000, 1000}}});
  b.json["scenes"][0]["nodes"] = {0, 1, 3};
  b.json["skins"][0]["joints"] = {3, 2, 1};  // the first moves no vertex
  add_weights(b, {2, 0, 0, 0, 1, 2, 0, 0, 0, 1, 9, 0},
              {1, 0, 0, 0, 0.25f, 0.75f, 0, 0, 0, 1, 0, 0});
  const Imported in = import_text(b.gltf(), "a.gltf");
  CHECK(corner(in.mesh, 0, 0) == Vec3d{0, 3, 0});
  CHECK(corner(in.mesh, 0, 1) == Vec3d{1.25, 3, 1.25});
  CHECK(corner(in.mesh, 0, 2) == Vec3d{0, 5, 5});
  CHECK(in.report.notes ==
        std::vector<std::string>{
            "a skinned mesh taken as the joints stand, without joints and weights"});

  // Half of the second vertex by a further set; sums other than one are shares.
  attributes_of(b)["JOINTS_1"] = b.add<std::uint16_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  attributes_of(b)["WEIGHTS_1"] =
      b.add<std::uint8_t>({0, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0}, "VEC4", true);
  CHECK(corner(import_text(b.gltf(), "a.gltf").mesh, 0, 1) == Vec3d{1.625, 3, 3.125});
}

TEST_CASE("glTF: what a skin bends has normals of the bent, and morphs come before") {
  GltfBuilder b = two_joints();
  const float h = std::sqrt(0.5f);
  attributes_of(b)["NORMAL"] = b.add<float>({h, 0, h, h, 0, h, h, 0, h}, "VEC3");
  b.json["nodes"][1]["scale"] = {2, 1, 1};
  b.json["nodes"][2]["scale"] = {3, 1, 1};  // 6 in all
  add_weights(b, {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0});
  b.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", b.add<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3")}}};
  b.json["meshes"][0]["weights"] = {1.0};
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{8, 3, 2.5});  // (2, 0, 0), four times as wide
  const double widths[] = {6, 4, 2};
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(length(normal_at(mesh, 0, c) - normalized(Vec3d{1 / widths[c], 0, 1})) < 1e-6);
  }
}

TEST_CASE("glTF: joints that mirror turn the winding") {
  GltfBuilder b = two_joints();
  b.json["nodes"][1]["scale"] = {-1, 1, 1};
  add_weights(b, {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0});
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(corner(mesh, 0, 1) == Vec3d{0, 4, 0});
  CHECK(corner(mesh, 0, 2) == Vec3d{-1, 3, 2.5});
}

//   2---1     two triangles with vertices of their own; those at the diagonal name their joints in
//   | / |     another order, and sums of thirds have other bits in another order
//   0---3
TEST_CASE("glTF: a seam stays closed whichever joint is named first") {
  GltfBuilder b = two_joints();
  b.json["nodes"][1]["translation"] = {0.1, 3.3, 0.7};
  b.json["nodes"].push_back({{"translation", {0.4, 0.7, 0.3}}});
  b.json["scenes"][0]["nodes"] = {0, 1, 3};
  b.json["skins"][0]["joints"] = {1, 2, 3};
  attributes_of(b)["POSITION"] =
      b.add<float>({0, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3");
  const std::vector<std::uint8_t> first = {0, 1, 2, 0}, other = {2, 0, 1, 0};
  std::vector<std::uint8_t> joints;
  for (int v = 0; v < 6; ++v) {
    const std::vector<std::uint8_t>& named = v < 3 ? first : other;
    joints.insert(joints.end(), named.begin(), named.end());
  }
  const std::vector<float> third = {1 / 3.0f, 1 / 3.0f, 1 / 3.0f, 0};
  std::vector<float> weights;
  for (int v = 0; v < 6; ++v) weights.insert(weights.end(), third.begin(), third.end());
  add_weights(b, joints, weights);
  CHECK(import_text(b.gltf(), "a.gltf").mesh.vertex_count() == 4);
}

TEST_CASE("glTF: joints may stand beside the scene, and what is broken there harms nobody") {
  GltfBuilder b = two_joints();
  b.json["scenes"] = {{{"nodes", {0}}}};
  add_weights(b, {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  const Mesh mesh = import_text(b.gltf(), "a.gltf").mesh;
  CHECK(corner(mesh, 0, 0) == Vec3d{0, 3, 5});
  CHECK(corner(mesh, 0, 2) == Vec3d{0, 4, 0});
  b.json["nodes"][2]["children"] = {1};  // a loop
  const Imported in = import_text(b.gltf(), "a.gltf");
  CHECK(corner(in.mesh, 0, 0) == Vec3d{0, 0, 0});
  CHECK(has_note(in.report, "2 joints of skins move nothing"));
  b.json["nodes"][2].erase("children");
  b.json["nodes"][2]["matrix"] = {1, 2};
  CHECK(corner(import_text(b.gltf(), "a.gltf").mesh, 0, 2) == Vec3d{0, 4, 0});
}

TEST_CASE("glTF: weights that cannot be meant are refused, with their place") {
  const auto refused = [](const char* words, auto harm) {
    GltfBuilder b = two_joints();
    add_weights(b, {0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    harm(b);
    const std::string message = refusal_of(b.gltf(), "a.gltf");
    CAPTURE(message);
    CHECK(message.find(words) != std::string::npos);
  };
  refused("attributes: vertex 2 hangs on joint 1, and the skin has 1",
          [](GltfBuilder& b) { b.json["skins"][0]["joints"] = {2}; });
  refused("WEIGHTS_0: not a value for every vertex", [](GltfBuilder& b) {
    attributes_of(b)["WEIGHTS_0"] = b.add<float>({1, 0, 0, 0}, "VEC4");
  });
  refused("JOINTS_0[1]: no joint", [](GltfBuilder& b) {
    attributes_of(b)["JOINTS_0"] = b.add<float>({0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  });
  refused("WEIGHTS_0[0]: not finite", [](GltfBuilder& b) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    attributes_of(b)["WEIGHTS_0"] = b.add<float>({nan, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  });
  refused("more than 32 joints a vertex", [](GltfBuilder& b) {
    for (int set = 1; set < 9; ++set) {
      for (const char* semantic : {"JOINTS_", "WEIGHTS_"}) {
        attributes_of(b)[semantic + std::to_string(set)] =
            attributes_of(b)[semantic + std::string("0")];
      }
    }
  });
}

}  // namespace crease
