// Images of materials: in from inside a glTF and from beside a file, out into a GLB and beside an
// OBJ. Nobody here looks inside, so the images are a signature and some letters.
#include "crease/export.h"
#include "crease/import.h"
#include "gltf_builder.h"
#include "test_folder.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace crease {
namespace {

std::string png(const std::string& inside) {
  return "\x89PNG\r\n\x1a\n" + inside;
}
std::string jpeg(const std::string& inside) {
  return "\xff\xd8\xff" + inside;
}

std::string text_of(const ImageFile& image) {
  return {reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size()};
}

// A triangle that is painted with image 0; `images` is the glTF's.
GltfBuilder painted(GltfBuilder::Json images) {
  GltfBuilder b;
  GltfBuilder::Json& primitive =
      b.primitive({{"POSITION", b.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3")},
                   {"TEXCOORD_0", b.add<float>({0, 1, 1, 1, 0, 0}, "VEC2")}});
  primitive["material"] = 0;
  b.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}}}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["images"] = std::move(images);
  return b;
}

std::size_t add_image(GltfBuilder& b, const std::string& bytes) {
  return b.add_view(std::vector<char>(bytes.begin(), bytes.end()));
}

Imported imported(const std::string& bytes, const char* name,
                  const std::filesystem::path* folder = nullptr) {
  Result<Imported> in = import_bytes(std::as_bytes(std::span(bytes)), name, {}, folder);
  REQUIRE(in.ok());
  return *std::move(in);
}

bool has_note(const Imported& in, const std::string& words) {
  return std::ranges::any_of(in.report.notes, [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

const char* kQuad =
    "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl wood\nf 1/1 2/2 3/3\nusemtl stone\nf 1/1 3/3 4/4\n";

TEST_CASE("glTF: images inside the file come along, by name, else by place") {
  GltfBuilder b = painted({{{"name", "wood"}}});
  b.json["images"][0]["bufferView"] = add_image(b, png("wood"));
  b.json["images"][0]["mimeType"] = "image/png";
  const Mesh mesh = imported(b.glb(), "m.glb").mesh;
  REQUIRE(mesh.images.size() == 1);
  CHECK(mesh.images[0].name == "wood");
  CHECK(mesh.materials[0].base_color_texture == "wood");
  CHECK(text_of(mesh.images[0]) == png("wood"));

  const Mesh uri =
      imported(painted({{{"uri", "data:image/jpeg;base64,/9j/QUJD"}}}).gltf(), "m.gltf").mesh;
  REQUIRE(uri.images.size() == 1);
  CHECK(uri.images[0].name == "images[0]");
  CHECK(text_of(uri.images[0]) == jpeg("ABC"));
}

TEST_CASE("glTF: images beside the file are found, and only there") {
  const Folder folder;
  folder.write("tex/my wood.png", png("wood"));
  folder.write("secret.png", png("secret"));
  std::filesystem::create_directories(folder.path / "in");
  const std::filesystem::path below = folder.path / "in";
  const Imported found =
      imported(painted({{{"uri", "tex/my%20wood.png"}}}).gltf(), "m.gltf", &folder.path);
  REQUIRE(found.mesh.images.size() == 1);
  CHECK(found.mesh.images[0].name == "tex/my wood.png");
  CHECK(found.report.notes.empty());
  for (const char* outside : {"../secret.png", "/etc/passwd", "http://host/secret.png"}) {
    const Imported in = imported(painted({{{"uri", outside}}}).gltf(), "m.gltf", &below);
    CHECK(in.mesh.images.empty());
    CHECK(has_note(in, "texture left out"));
  }
}

TEST_CASE("glTF: an image that is none, or not there, is a note and no failure") {
  GltfBuilder webp = painted({{{"mimeType", "image/webp"}}});
  webp.json["images"][0]["bufferView"] = add_image(webp, "RIFFxxxxWEBP");
  const Folder folder;
  const auto note_of = [&](const GltfBuilder& b) {
    const Imported in = imported(b.glb(), "m.glb", &folder.path);  // looks for others beside it
    CHECK(in.mesh.materials[0].base_color_texture.empty());
    REQUIRE(in.report.notes.size() == 1);
    return in.report.notes[0];
  };
  CHECK(note_of(webp) ==
        "texture left out: m.glb: images[0]: is neither a PNG nor a JPEG, but WebP");
  CHECK(note_of(painted({{{"bufferView", 17}}})) ==
        "texture left out: m.glb: images[0].bufferView: no such bufferView");
  GltfBuilder none = painted({});
  none.json["textures"] = {GltfBuilder::Json::object()};
  CHECK(note_of(none) == "texture left out: m.glb: textures[0]: has no image");
}

TEST_CASE("glTF: the coordinates that a texture goes by come first, and transformed") {
  GltfBuilder b = painted({{{"uri", "wood.png"}}});
  GltfBuilder::Json& primitive = b.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TEXCOORD_1"] = b.add<float>({0, 0, 0.5f, 0, 0, 0.5f}, "VEC2");
  GltfBuilder::Json& info = b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  info["texCoord"] = 1;
  // A quarter of a turn counter-clockwise as seen, v being down: u goes up.
  info["extensions"]["KHR_texture_transform"] = {
      {"scale", {2, 4}}, {"rotation", 1.57079632679}, {"offset", {0.25, 0.5}}};
  const Mesh mesh = imported(b.glb(), "m.glb").mesh;
  const auto uv = std::ranges::find(mesh.layers, "uv", &AttributeLayer::name);
  REQUIRE(uv != mesh.layers.end());
  const float expected[3][2] = {{0.25f, 0.5f}, {0.25f, -0.5f}, {2.25f, 0.5f}};  // v down
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<const float> value = uv->value(uv->of_corner[c]);
    CHECK(value[0] == doctest::Approx(expected[c][0]));
    CHECK(1 - value[1] == doctest::Approx(expected[c][1]));
  }
}

TEST_CASE("OBJ: images are beside the library, or beside the file after all") {
  const Folder folder;
  folder.write("quad.obj", std::string(kQuad).replace(7, 8, "lib/quad.mtl"));
  folder.write("lib/quad.mtl",
               "newmtl wood\nmap_Kd -s 1 1 1 wood.png\nnewmtl stone\nmap_Kd C:\\mine\\stone.JPG\n");
  folder.write("lib/wood.png", png("wood"));
  folder.write("stone.JPG", jpeg("stone"));
  const Result<Imported> in = import_mesh(folder.path / "quad.obj", {});
  REQUIRE(in.ok());
  CHECK(in->report.notes.empty());
  REQUIRE(in->mesh.images.size() == 2);
  CHECK(in->mesh.images[0].name == "lib/wood.png");
  CHECK(text_of(in->mesh.images[1]) == jpeg("stone"));
  CHECK(find_image(in->mesh.images, in->mesh.materials[1].base_color_texture) != nullptr);
}

TEST_CASE("OBJ: scale and offset of a texture are in the coordinates") {
  const Folder folder;
  folder.write("quad.obj", kQuad);
  folder.write("quad.mtl",
               "newmtl wood\nmap_Kd -s 2 3 1 -clamp on -colorspace sRGB -o 0.5 red tex.png\n");
  const Result<Imported> in = import_mesh(folder.path / "quad.obj", {});
  REQUIRE(in.ok());
  const Mesh& mesh = in->mesh;
  CHECK(mesh.materials[0].base_color_texture == "red tex.png");
  const auto uv = std::ranges::find(mesh.layers, "uv", &AttributeLayer::name);
  REQUIRE(uv != mesh.layers.end());
  const float expected[6][2] = {{0.5f, 0}, {2.5f, 0}, {2.5f, 3}, {0, 0}, {1, 1}, {0, 1}};
  for (std::size_t c = 0; c < 6; ++c) {  // the other material has the file's
    CHECK(uv->value(uv->of_corner[c])[0] == expected[c][0]);
    CHECK(uv->value(uv->of_corner[c])[1] == expected[c][1]);
  }
}

TEST_CASE("equal images are one, and different ones of a name are told apart") {
  const Folder folder;
  for (const std::string part : {"a", "b", "c"}) {
    folder.write(part + "/quad.obj", kQuad);
    folder.write(part + "/quad.mtl", "newmtl wood\nmap_Kd wood.png\nnewmtl stone\nmap_Kd s.png\n");
    folder.write(part + "/wood.png", png(part == "b" ? "b" : "a"));
    folder.write(part + "/s.png", png("a"));
  }
  const std::filesystem::path paths[] = {folder.path / "a/quad.obj", folder.path / "b/quad.obj",
                                         folder.path / "c/quad.obj"};
  const Result<Imported> in = import_meshes(paths, {});
  REQUIRE(in.ok());
  const Mesh& mesh = in->mesh;
  CHECK(check_mesh(mesh).ok());
  REQUIRE(mesh.images.size() == 2);
  const auto shown = [&](std::size_t triangle) {
    const Material& material = mesh.materials[index_of(mesh.material_of_triangle[triangle])];
    const ImageFile* image = find_image(mesh.images, material.base_color_texture);
    return image == nullptr ? "" : text_of(*image);
  };
  for (std::size_t t = 0; t < 6; ++t) CHECK(shown(t) == png(t == 2 ? "b" : "a"));
}

TEST_CASE("what was not found at first is found in another folder later") {
  const Folder folder;
  const std::vector<Material> materials = {{"a", {1, 1, 1, 1}, "tex/wood.png"},
                                           {"b", {1, 1, 1, 1}, "gone.png"},
                                           {"c", {1, 1, 1, 1}, "gone.png"},
                                           {"d", {1, 1, 1, 1}, ""}};
  folder.write("wood.png", png("wood"));
  std::vector<ImageFile> images;
  const std::vector<std::string> notes = find_images({&folder.path, 1}, materials, images);
  CHECK(notes == std::vector<std::string>{"texture left out: no file 'gone.png'"});
  REQUIRE(images.size() == 1);
  CHECK(images[0].name == "tex/wood.png");

  const Folder other;
  other.write("gone.png", png("gone"));
  other.write("wood.png", png("another"));
  const std::filesystem::path both[] = {folder.path, other.path};
  images.clear();
  CHECK(find_images(both, materials, images).empty());
  REQUIRE(images.size() == 2);
  CHECK(text_of(images[0]) == png("wood"));
  CHECK(text_of(images[1]) == png("gone"));
}

TEST_CASE("an image whose name differs by case is found where none has its own") {
  const Folder folder;
  folder.write("Tex/WOOD.png", png("large"));
  folder.write("Tex/Wood.PNG", png("both"));
  std::vector<ImageFile> images;
  const auto found_as = [&](const std::string& name) {
    images.clear();
    find_images({&folder.path, 1}, std::vector<Material>{{"a", {1, 1, 1, 1}, name}}, images);
    return images.empty() ? "" : text_of(images[0]);
  };
  CHECK(found_as("Tex/Wood.PNG") == png("both"));
  CHECK(found_as("tex/wood.png") == png("large"));
  CHECK(found_as("TEX\\wOOD.pNG") == png("large"));
  CHECK(found_as("tex/wool.png").empty());
}

TEST_CASE("a model's textures may be in a folder of their own") {
  const Folder folder, other;
  folder.write("quad.obj", kQuad);
  folder.write("quad.mtl", "newmtl wood\nmap_Kd ../tex/wood.png\n");
  other.write("wood.png", png("wood"));
  const Result<Imported> without = import_mesh(folder.path / "quad.obj", {});
  REQUIRE(without.ok());
  CHECK(without->mesh.images.empty());
  CHECK(has_note(*without, "outside the model's folder"));
  ImportOptions options;
  options.texture_folder = other.path;
  const Result<Imported> with = import_mesh(folder.path / "quad.obj", options);
  REQUIRE(with.ok());
  REQUIRE(with->mesh.images.size() == 1);
  CHECK(text_of(with->mesh.images[0]) == png("wood"));
  CHECK(!has_note(*with, "texture left out"));
}

Mesh painted_quad() {
  const Folder folder;
  folder.write("quad.obj", kQuad);
  folder.write("quad.mtl", "newmtl wood\nmap_Kd a/wood.png\nnewmtl stone\nmap_Kd b/wood.png\n");
  folder.write("a/wood.png", png("wood"));
  folder.write("b/wood.png", jpeg("stone"));
  Result<Imported> in = import_mesh(folder.path / "quad.obj", {});
  REQUIRE(in.ok());
  return std::move(in->mesh);
}

TEST_CASE("images go into a GLB and come back, byte for byte") {
  const Mesh mesh = painted_quad();
  const Result<std::vector<std::byte>> glb = export_bytes(mesh, ".glb");
  REQUIRE(glb.ok());
  const Result<Imported> in = import_bytes(*glb, "m.glb", {});
  REQUIRE(in.ok());
  CHECK(in->report.notes.empty());
  CHECK(in->mesh.materials == mesh.materials);
  REQUIRE(in->mesh.images.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(in->mesh.images[i].name == mesh.images[i].name);
    CHECK(*in->mesh.images[i].bytes == *mesh.images[i].bytes);
  }
}

TEST_CASE("without texture coordinates a GLB has the texture's name only") {
  Mesh mesh = painted_quad();
  std::erase_if(mesh.layers, [](const auto& l) { return l.role == AttributeRole::TexCoord; });
  const Result<std::vector<std::byte>> glb = export_bytes(mesh, ".glb");
  REQUIRE(glb.ok());
  const Result<Imported> in = import_bytes(*glb, "m.glb", {});
  REQUIRE(in.ok());
  CHECK(in->mesh.images.empty());
  CHECK(in->mesh.materials == mesh.materials);
}

TEST_CASE("images go beside an OBJ under names of its own, and come back") {
  const Folder folder;
  const Mesh mesh = painted_quad();
  REQUIRE(export_mesh(mesh, folder.path / "level.obj").ok());
  CHECK(folder.read("level_wood.png") == png("wood"));
  CHECK(folder.read("level_wood.png.jpg") == jpeg("stone"));
  const Result<Imported> in = import_mesh(folder.path / "level.obj", {});
  REQUIRE(in.ok());
  CHECK(in->report.notes.empty());
  REQUIRE(in->mesh.images.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) CHECK(*in->mesh.images[i].bytes == *mesh.images[i].bytes);

  // A place that cannot be written: nothing is left behind.
  std::filesystem::create_directory(folder.path / "other.obj");
  CHECK(!export_mesh(mesh, folder.path / "other.obj").ok());
  for (const auto& entry : std::filesystem::directory_iterator(folder.path)) {
    CHECK(entry.path().string().find(".part") == std::string::npos);
  }
}

}  // namespace
}  // namespace crease
