// What meshoptimizer and Draco have compressed is read as what it was.
#include "crease/import.h"
#include "io/gltf_builder.h"
#include "support/described_mesh.h"

#include <doctest/doctest.h>
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace crease {
namespace {

using Json = GltfBuilder::Json;

// A wavy square, indexed: positions, smooth normals, colours of bytes.
struct Wave {
  static constexpr std::uint32_t kSide = 20;
  std::vector<float> positions, normals;
  std::vector<std::uint8_t> colors;  // 4 a vertex
  std::vector<std::uint32_t> indices;

  Wave() {
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const float x = float(i % kSide), y = float(i / kSide);
      positions.insert(positions.end(), {x, y, std::sin(x / 3)});
      const Vec3d n = normalized(Vec3d{-std::cos(double(x) / 3) / 3, 0, 1});
      normals.insert(normals.end(), {float(n.x), float(n.y), float(n.z)});
      colors.insert(colors.end(), {std::uint8_t(i), std::uint8_t(i / 2), 200, 255});
      if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
      indices.insert(indices.end(), {i, i + 1, i + kSide + 1, i, i + kSide + 1, i + kSide});
    }
  }
  std::size_t count() const { return positions.size() / 3; }
};

GltfBuilder plain(const Wave& wave) {
  GltfBuilder b;
  const std::size_t indices = b.add(wave.indices, "SCALAR");
  b.primitive({{"POSITION", b.add(wave.positions, "VEC3")},
               {"NORMAL", b.add(wave.normals, "VEC3")},
               {"COLOR_0", b.add(wave.colors, "VEC4", true)}},
              indices);
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

Result<Imported> imported(const GltfBuilder& b) {
  const std::string glb = b.glb();
  return import_bytes(std::as_bytes(std::span(glb)), "wave.glb", {});
}

DescribedMesh described_import(const GltfBuilder& b) {
  const Result<Imported> in = imported(b);
  REQUIRE_MESSAGE(in.ok(), (in.ok() ? "" : in.failure().message));
  return described(in->mesh);
}

// The bytes of view `index` take the place of what was there.
void compress_view(GltfBuilder& b, std::size_t index, const std::string& mode,
                   const std::vector<unsigned char>& encoded, std::size_t stride,
                   std::size_t count) {
  const std::size_t at = b.add_view(encoded);
  Json extension = b.json["bufferViews"][at];
  extension["byteLength"] = encoded.size();
  extension.update({{"mode", mode}, {"byteStride", stride}, {"count", count}});
  Json& view = b.json["bufferViews"][index];
  view["buffer"] = 1;  // the fallback, which has no bytes
  view["byteLength"] = stride * count;
  view["byteOffset"] = 0;
  view["extensions"]["EXT_meshopt_compression"] = extension;
}

template <typename T>
std::vector<unsigned char> encoded_vertices(const std::vector<T>& values, std::size_t count) {
  const std::size_t stride = values.size() / count * sizeof(T);
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(count, stride));
  bytes.resize(
      meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), count, stride));
  return bytes;
}

GltfBuilder meshopt_compressed(const Wave& wave, const std::string& index_mode) {
  GltfBuilder b = plain(wave);
  b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const std::size_t n = wave.indices.size();
  std::vector<unsigned char> indices;
  if (index_mode == "TRIANGLES") {
    indices.resize(meshopt_encodeIndexBufferBound(n, wave.count()));
    indices.resize(
        meshopt_encodeIndexBuffer(indices.data(), indices.size(), wave.indices.data(), n));
  } else {
    indices.resize(meshopt_encodeIndexSequenceBound(n, wave.count()));
    indices.resize(
        meshopt_encodeIndexSequence(indices.data(), indices.size(), wave.indices.data(), n));
  }
  compress_view(b, 0, index_mode, indices, 4, n);
  compress_view(b, 1, "ATTRIBUTES", encoded_vertices(wave.positions, wave.count()), 12,
                wave.count());
  compress_view(b, 2, "ATTRIBUTES", encoded_vertices(wave.normals, wave.count()), 12, wave.count());
  compress_view(b, 3, "ATTRIBUTES", encoded_vertices(wave.colors, wave.count()), 4, wave.count());
  return b;
}

TEST_CASE("buffer views that meshoptimizer compressed") {
  const Wave wave;
  const DescribedMesh expected = described_import(plain(wave));
  CHECK(described_import(meshopt_compressed(wave, "TRIANGLES")) == expected);
  CHECK(described_import(meshopt_compressed(wave, "INDICES")) == expected);

  GltfBuilder renamed = meshopt_compressed(wave, "TRIANGLES");  // nothing else is different
  renamed.json["extensionsRequired"] = {"KHR_meshopt_compression"};
  for (Json& view : renamed.json["bufferViews"]) {
    if (!view.contains("extensions")) continue;
    const Json extension = view["extensions"]["EXT_meshopt_compression"];
    view["extensions"] = {{"KHR_meshopt_compression", extension}};
  }
  CHECK(described_import(renamed) == expected);
}

TEST_CASE("normals through meshoptimizer's octahedral filter") {
  const Wave wave;
  std::vector<float> four;
  for (std::size_t i = 0; i < wave.count(); ++i) {
    four.insert(four.end(),
                {wave.normals[3 * i], wave.normals[3 * i + 1], wave.normals[3 * i + 2], 0});
  }
  std::vector<std::int16_t> filtered(four.size());
  meshopt_encodeFilterOct(filtered.data(), wave.count(), 8, 16, four.data());
  GltfBuilder b = plain(wave);
  b.json["accessors"][2].update({{"componentType", 5122}, {"normalized", true}});
  compress_view(b, 2, "ATTRIBUTES", encoded_vertices(filtered, wave.count()), 8, wave.count());
  b.json["bufferViews"][2]["extensions"]["EXT_meshopt_compression"]["filter"] = "OCTAHEDRAL";
  const Result<Imported> in = imported(b), exact = imported(plain(wave));
  REQUIRE_MESSAGE(in.ok(), (in.ok() ? "" : in.failure().message));
  for (std::size_t c = 0; c < 3 * in->mesh.triangle_count(); ++c) {
    const auto n = in->mesh.normals()->value(in->mesh.normals()->of_corner[c]);
    const auto m = exact->mesh.normals()->value(exact->mesh.normals()->of_corner[c]);
    for (std::size_t k = 0; k < 3; ++k) REQUIRE(n[k] == doctest::Approx(m[k]).epsilon(1e-3));
  }
}

TEST_CASE("buffer views that are compressed wrongly are refused") {
  const Wave wave;
  const auto refused = [&](const std::string& words, auto harm) {
    CAPTURE(words);
    GltfBuilder b = meshopt_compressed(wave, "TRIANGLES");
    harm(b.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"]);
    const Result<Imported> in = imported(b);
    REQUIRE(!in.ok());
    CHECK_MESSAGE(in.failure().message.find("bufferViews[1]") != std::string::npos,
                  in.failure().message);
    CHECK_MESSAGE(in.failure().message.find(words) != std::string::npos, in.failure().message);
  };
  refused("mode, filter", [](Json& e) { e["mode"] = "CIRCLES"; });
  refused("mode, filter", [](Json& e) { e["filter"] = "QUATERNION"; });
  refused("mode, filter", [](Json& e) { e["byteStride"] = 10; });
  refused("elements in", [](Json& e) { e["count"] = 4'000'000'000u; });
  refused("elements in", [](Json& e) { e["count"] = 18446744073709551615ull; });
  refused("not what meshoptimizer", [](Json& e) { e["count"] = 4000; });
  refused("not what meshoptimizer", [](Json& e) { e["byteLength"] = 200; });
  refused("reaches to byte", [](Json& e) { e["byteOffset"] = 1'000'000; });
}

template <std::size_t N, typename T>
std::array<T, N> value_of(const std::vector<T>& values, std::uint32_t vertex) {
  std::array<T, N> value;
  std::copy_n(values.begin() + std::ptrdiff_t(N) * vertex, N, value.begin());
  return value;
}

// The whole primitive as Draco has it, nothing quantized.
GltfBuilder draco_compressed(const Wave& wave) {
  draco::TriangleSoupMeshBuilder soup;
  soup.Start(int(wave.indices.size() / 3));
  const int position = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = soup.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const int color = soup.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (std::uint32_t f = 0; f < wave.indices.size() / 3; ++f) {
    const std::uint32_t* v = &wave.indices[3 * f];
    const auto set = [&]<std::size_t N, typename T>(int attribute, const std::vector<T>& values) {
      const auto a = value_of<N>(values, v[0]), b = value_of<N>(values, v[1]),
                 c = value_of<N>(values, v[2]);
      soup.SetAttributeValuesForFace(attribute, draco::FaceIndex(f), a.data(), b.data(), c.data());
    };
    set.operator()<3>(position, wave.positions);
    set.operator()<3>(normal, wave.normals);
    set.operator()<4>(color, wave.colors);
  }
  const std::unique_ptr<draco::Mesh> mesh = soup.Finalize();
  REQUIRE(mesh != nullptr);
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

  GltfBuilder b;
  const std::size_t view =
      b.add_view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
  b.json["bufferViews"][view]["byteLength"] = buffer.size();
  const std::size_t vertices = mesh->num_points();
  const auto accessor = [&](int component_type, const char* type, std::size_t count) {
    return b.add_accessor({{"componentType", component_type}, {"count", count}, {"type", type}});
  };
  const std::size_t indices = accessor(5125, "SCALAR", wave.indices.size());
  const std::size_t colors = accessor(5121, "VEC4", vertices);
  b.json["accessors"][colors]["normalized"] = true;
  Json& primitive = b.primitive({{"POSITION", accessor(5126, "VEC3", vertices)},
                                 {"NORMAL", accessor(5126, "VEC3", vertices)},
                                 {"COLOR_0", colors}},
                                indices);
  const auto id = [&](int attribute) { return mesh->attribute(attribute)->unique_id(); };
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view},
      {"attributes", {{"POSITION", id(position)}, {"NORMAL", id(normal)}, {"COLOR_0", id(color)}}}};
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  b.json["nodes"] = {{{"mesh", 0}}};
  return b;
}

TEST_CASE("primitives that Draco compressed") {
  const Wave wave;
  CHECK(described_import(draco_compressed(wave)) == described_import(plain(wave)));
}

TEST_CASE("what Draco holds counts, whatever accessors say of it, which is told") {
  const Wave wave;
  for (const std::size_t accessor : {0, 2}) {  // indices, positions
    GltfBuilder b = draco_compressed(wave);
    b.json["accessors"][accessor]["count"] = 17;
    CHECK(described_import(b) == described_import(plain(wave)));
    CHECK(imported(b)->report.notes[0] ==
          "1 primitives whose accessors' counts are not those of what Draco holds, which is taken");
  }
}

TEST_CASE("primitives that are compressed wrongly are refused") {
  const Wave wave;
  const auto refused = [&](const std::string& words, auto harm) {
    CAPTURE(words);
    GltfBuilder b = draco_compressed(wave);
    harm(b, b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]);
    const Result<Imported> in = imported(b);
    REQUIRE(!in.ok());
    CHECK_MESSAGE(in.failure().message.find(words) != std::string::npos, in.failure().message);
  };
  refused("no such bufferView", [](GltfBuilder&, Json& e) { e["bufferView"] = 9; });
  refused("no attribute 77", [](GltfBuilder&, Json& e) { e["attributes"]["NORMAL"] = 77; });
  refused("'TANGENT'", [](GltfBuilder&, Json& e) { e["attributes"]["TANGENT"] = 0; });
  refused("values of", [](GltfBuilder& b, Json&) { b.json["accessors"][1]["type"] = "VEC3"; });
  refused("values for", [](GltfBuilder& b, Json& e) {  // colours outside of Draco
    b.json["accessors"][1]["count"] = 17;
    e["attributes"].erase("COLOR_0");
  });
  for (std::size_t length = 0; length < 200; length += 7) {
    refused("Draco",
            [&](GltfBuilder& b, Json&) { b.json["bufferViews"][0]["byteLength"] = length; });
  }
}

}  // namespace
}  // namespace crease
