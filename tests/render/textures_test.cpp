// Images as textures: decoding, how they become a few arrays, and the pictures.
#include "render/textures.h"
#include "render/pixels.h"
#include "support/painted_sheet.h"

#include <doctest/doctest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <string>
#include <vector>

namespace crease {

namespace {

ImageFile image_file(std::string name, std::vector<std::byte> bytes) {
  return {std::move(name), std::make_shared<const std::vector<std::byte>>(std::move(bytes))};
}

ImageFile png_file(std::string name, int width, int height, const ColorSrgb& color) {
  Image image{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    image.rgba.insert(image.rgba.end(), {color[0], color[1], color[2], 255});
  }
  return image_file(std::move(name), *encode_png(image));
}

std::vector<std::byte> jpeg_of(const Image& image) {
  tjhandle encoder = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  REQUIRE(tjCompress2(encoder, image.rgba.data(), image.width, 0, image.height, TJPF_RGBA, &bytes,
                      &size, TJSAMP_444, 95, 0) == 0);
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  std::vector<std::byte> result(first, first + size);
  tjFree(bytes);
  tjDestroy(encoder);
  return result;
}

// A head that says how large the picture is, with a right checksum, and no pixels behind it.
std::vector<std::byte> png_head(std::uint32_t width, std::uint32_t height) {
  std::vector<std::uint8_t> all{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto put = [&](std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) all.push_back(std::uint8_t(value >> shift));
  };
  const auto end_chunk = [&](std::size_t first) {
    std::uint32_t crc = 0xffffffff;
    for (std::size_t i = first; i < all.size(); ++i) {
      crc ^= all[i];
      for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    put(~crc);
  };
  put(13);
  all.insert(all.end(), {'I', 'H', 'D', 'R'});
  put(width);
  put(height);
  all.insert(all.end(), {8, 2, 0, 0, 0});
  end_chunk(12);
  put(0);
  all.insert(all.end(), {'I', 'D', 'A', 'T'});
  end_chunk(all.size() - 4);
  std::vector<std::byte> bytes;
  for (const std::uint8_t b : all) bytes.push_back(std::byte{b});
  return bytes;
}

// From above, so that x goes right and y up, and the sheet fills the middle.
RenderOptions from_above() {
  RenderOptions options;
  options.width_px = options.height_px = 120;
  Camera camera;
  camera.position = {0.5, 0.5, 2};
  camera.target = {0.5, 0.5, 0};
  camera.up = {0, 1, 0};
  camera.width_px = camera.height_px = 120;
  camera.vertical_fov_deg = 30;
  options.camera = camera;
  return options;
}

Pixel at(const Image& image, const RenderOptions& options, double x, double y) {
  const auto [px, py] = project(*options.camera, {x, y, 0});
  return pixel_at(image, int(px), int(py));
}

// By rows: those of the image, v up.
void check_quarters(const Image& image, const RenderOptions& options) {
  for (const double x : {0.06, 0.2, 0.3, 0.4, 0.45, 0.55, 0.62, 0.7, 0.8, 0.94}) {
    for (const double y : {0.06, 0.25, 0.45, 0.55, 0.75, 0.94}) {
      CAPTURE(x);
      CAPTURE(y);
      const Pixel p = at(image, options, x, y);
      CHECK(nearest_quarter(p[0], p[1], p[2]) == (x > 0.5) + 2 * (y < 0.5));
    }
  }
}

}  // namespace

TEST_CASE("a texture lies on the surface as its coordinates say, in all three kinds of triangles") {
  const Mesh mesh = painted_sheet(12);
  const MeshDrawArrays arrays(mesh);
  const DrawList list = arrays.draw_list();
  REQUIRE(list.sn.triangle_count() > 0);
  REQUIRE(list.fn.triangle_count() > 0);
  REQUIRE(list.nsn.triangle_count() > 0);
  RenderOptions options = from_above();
  check_quarters(draw(list, options), options);
  options.wireframe = true;
  options.camera->vertical_fov_deg = 20;
  draw(list, options);
}

TEST_CASE("a JPEG is drawn as well, times base colour and vertex colours") {
  Mesh mesh = painted_sheet(6);
  mesh.images = {image_file("quarters.png", jpeg_of(*decode_image(*quarters_png().bytes)))};
  RenderOptions options = from_above();
  check_quarters(draw(MeshDrawArrays(mesh).draw_list(), options), options);

  // What is yellow loses its red by the base colour, and its green by that of the vertices.
  mesh.materials[0].base_color = {0, 1, 1, 1};
  const Pixel green = at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.8, 0.2);
  CHECK(green[0] < 70);
  CHECK(green[1] > 150);
  mesh.layers.push_back({"color", AttributeRole::Color, Interpolation::Linear, 3, {1, 0, 1}, {}});
  mesh.layers.back().of_corner.assign(3 * mesh.triangle_count(), AttributeId{0});
  const Pixel dark = at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.8, 0.2);
  CHECK(std::max({dark[0], dark[1], dark[2]}) < 80);
}

TEST_CASE(
    "a vertex's colour looks as a material's of the same light, and as a picture's of its bytes") {
  const ColorSrgb bytes{60, 140, 50};
  const RenderOptions options = from_above();
  Mesh plain = painted_sheet(6);
  plain.images.clear();
  plain.materials = {{"paint", {1, 1, 1, 1}, ""}};
  const auto middle_of = [&](const Mesh& mesh) {
    return at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.2, 0.5);
  };
  Mesh of_vertices = plain, of_material = plain, of_picture = plain;
  AttributeLayer colors{"color", AttributeRole::Color, Interpolation::Linear, 3, {}, {}};
  for (const std::uint8_t b : bytes) colors.values.push_back(float(b) / 255);
  colors.of_corner.assign(3 * plain.triangle_count(), AttributeId{0});
  of_vertices.layers.push_back(std::move(colors));
  const Color light = linear_from_srgb(bytes);
  of_material.materials[0].base_color = {light[0], light[1], light[2], 1};
  of_picture.images = {png_file("one.png", 4, 4, bytes)};
  of_picture.materials[0].base_color_texture = "one.png";
  const Pixel wanted = middle_of(of_material);
  for (const Mesh& mesh : {of_vertices, of_picture}) {
    const Pixel got = middle_of(mesh);
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(int(got[k]) - int(wanted[k])) <= 1);
  }
  CHECK(wanted[1] > 2 * wanted[0]);
}

TEST_CASE("where the alpha of a texture is below the cutoff there is a hole") {
  Mesh mesh = painted_sheet(4);
  const RenderOptions options = from_above();
  const auto middle = [&](float cutoff) {
    mesh.materials[0].alpha_cutoff = cutoff;
    return at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.4, 0.4);
  };
  const Pixel opaque = middle(0);
  CHECK(middle(1) == opaque);  // its alpha is 1
  const Pixel hole = middle(2);
  CHECK(hole != opaque);
  CHECK(std::abs(int(hole[0]) - int(hole[2])) < 24);  // the background, which is nearly grey
}

TEST_CASE("what is blended covers as much of a pixel as its alpha says, without an order") {
  Mesh mesh = painted_sheet(4);
  mesh.images.clear();
  mesh.materials = {{"glass", {0.2f, 0.4f, 1, 1}, ""}};
  RenderOptions options = from_above();
  const auto with_alpha = [&](float alpha) {
    mesh.materials[0].base_color[3] = alpha;
    return at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.4, 0.4);
  };
  const Pixel opaque = with_alpha(1), half = with_alpha(0.5f), clear = with_alpha(0);
  const auto between = [&](const Pixel& p) { return int(p[2]) - int(p[0]); };  // how blue
  CHECK(between(opaque) > 100);
  CHECK(between(half) < between(opaque) - 20);
  CHECK(between(clear) < between(half) - 20);
  CHECK(between(clear) > 12);  // what a file calls clear is seen all the same
}

TEST_CASE("through two panes one sees the share of each that its alpha and those before it say") {
  Mesh mesh = painted_sheet(1);
  mesh.images.clear();
  mesh.layers.resize(1);
  mesh.materials = {{"front", {0, 0, 1, 1}, ""}, {"behind", {1, 0, 0, 1}, ""}};
  const std::size_t triangles = mesh.triangle_count();
  const auto positions = std::uint32_t(mesh.vertex_count());
  mesh.material_of_triangle.assign(triangles, MaterialId{0});
  mesh.material_of_triangle.resize(2 * triangles, MaterialId{1});
  for (std::uint32_t v = 0; v < positions; ++v) {
    mesh.positions.push_back(mesh.positions[v] - Vec3d{0, 0, 0.2});
  }
  for (std::size_t t = 0; t < triangles; ++t) {
    Triangle behind = mesh.triangles[t];
    for (VertexId& v : behind) v = VertexId(std::uint32_t(v) + positions);
    mesh.triangles.push_back(behind);
  }
  AttributeLayer& normals = mesh.layers[0];
  normals.of_corner.insert(normals.of_corner.end(), normals.of_corner.begin(),
                           normals.of_corner.begin() + std::ptrdiff_t(3 * triangles));
  RenderOptions options = from_above();
  // In light, averaged over the middle of the picture.
  const auto light_of = [&](const DrawList& list) {
    const Image image = draw(list, options);
    Color sum{};
    for (int y = 50; y < 70; ++y) {
      for (int x = 50; x < 70; ++x) {
        const Pixel p = pixel_at(image, x, y);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += linear_from_srgb(float(p[c]) / 255) / 400;
      }
    }
    return sum;
  };
  const auto with_alphas = [&](float front, float behind) {
    mesh.materials[0].base_color[3] = front;
    mesh.materials[1].base_color[3] = behind;
    return light_of(MeshDrawArrays(mesh).draw_list());
  };
  const Color front = with_alphas(1, 1), clear = light_of({});
  const Color half = with_alphas(0.5f, 1), both = with_alphas(0.5f, 0.5f);
  const Color faint = with_alphas(0.3f, 1);
  mesh.material_of_triangle.assign(2 * triangles, MaterialId{1});
  const Color behind = with_alphas(1, 1);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(std::abs(half[c] - (front[c] + behind[c]) / 2) < 0.02);
    CHECK(std::abs(faint[c] - (0.3f * front[c] + 0.7f * behind[c])) < 0.02);
    CHECK(std::abs(both[c] - (2 * front[c] + behind[c] + clear[c]) / 4) < 0.03);
  }
}

TEST_CASE("a texture's alpha counts where its material is blended, and nowhere else") {
  Mesh mesh = painted_sheet(4);
  Image faint = *decode_image(*mesh.images[0].bytes);
  for (std::size_t i = 3; i < faint.rgba.size(); i += 4) faint.rgba[i] = 0;
  mesh.images[0] = image_file(mesh.images[0].name, *encode_png(faint));
  const RenderOptions options = from_above();
  const auto middle = [&](bool is_blended) {
    mesh.materials[0].is_blended = is_blended;
    return at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.4, 0.4);
  };
  const Pixel nothing = middle(true);
  CHECK(std::abs(int(nothing[0]) - int(nothing[2])) < 24);  // the background
  CHECK(middle(false) != nothing);
}

TEST_CASE("textures repeat, and triangles of other materials have their own") {
  Mesh mesh = painted_sheet(12);
  for (float& x : mesh.layers[1].values) x = 3 * x - 1;  // the middle is the image once
  RenderOptions options = from_above();
  const Image repeated = draw(MeshDrawArrays(mesh).draw_list(), options);
  for (const double x : {0.06, 0.4, 0.73}) {
    const Pixel p = at(repeated, options, x, 0.95);
    CHECK(nearest_quarter(p[0], p[1], p[2]) == 0);
  }
  // Nine sizes, which become four arrays.
  mesh.materials.clear();
  mesh.images.clear();
  const ColorSrgb colors[] = {{250, 30, 30}, {30, 200, 30}, {40, 60, 250}};
  for (std::uint32_t m = 0; m < 9; ++m) {
    const std::string name = "image " + std::to_string(m);
    mesh.materials.push_back({name, {1, 1, 1, 1}, name});
    mesh.images.push_back(png_file(name, int(4 + 3 * m), int(40 - 4 * m), colors[m % 3]));
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    mesh.material_of_triangle[t] = MaterialId{std::uint32_t(t / 2 / 12 * 9 / 12)};
  }
  const Image rows = draw(MeshDrawArrays(mesh).draw_list(), options);
  for (std::uint32_t row = 0; row < 12; ++row) {
    const Pixel p = at(rows, options, 0.8, (row + 0.5) / 12);
    CHECK(nearest_quarter(p[0], p[1], p[2]) == int(row * 9 / 12 % 3));
  }
}

TEST_CASE("what cannot be decoded is told, and its material has its base colour") {
  struct Broken {
    std::vector<std::byte> bytes;
    const char* words;
  };
  std::vector<std::byte> cut = *quarters_png().bytes;
  cut.resize(60);
  std::vector<std::byte> cut_jpeg = jpeg_of(*decode_image(*quarters_png().bytes));
  cut_jpeg.resize(20);
  const std::vector<std::byte> nothing(12, std::byte{7});
  const Broken all[] = {{cut, "PNG: "},
                        {cut_jpeg, "without pixels"},
                        {nothing, "neither a PNG nor a JPEG"},
                        {png_head(60'000, 60'000), "60000 x 60000 pixels"},
                        {png_head(20'000, 20'000), "20000 x 20000 pixels"},
                        {png_head(2'000'000'000, 1), "PNG"},
                        {png_head(8, 8), "PNG: "}};
  for (const Broken& broken : all) {
    const std::string words = broken.words;
    CAPTURE(words);
    Mesh mesh = painted_sheet(3);
    mesh.materials[0].base_color = {0, 0.6f, 0, 1};
    mesh.images = {image_file("quarters.png", broken.bytes)};
    RenderOptions options = from_above();
    std::vector<std::string> notes;
    options.on_note = [&](const std::string& note) { notes.push_back(note); };
    const Pixel p = at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.2, 0.2);
    CHECK(nearest_quarter(p[0], p[1], p[2]) == 1);
    REQUIRE(notes.size() == 1);
    CAPTURE(notes[0]);
    CHECK(notes[0].find("texture 'quarters.png' is not drawn: ") == 0);
    CHECK(notes[0].find(words) != std::string::npos);
  }
  // One that is not there at all: whoever looked for it has said so.
  Mesh mesh = painted_sheet(3);
  mesh.materials[0].base_color = {0, 0.6f, 0, 1};
  mesh.images.clear();
  RenderOptions options = from_above();
  options.on_note = [](const std::string& note) { FAIL(note); };
  const Pixel p = at(draw(MeshDrawArrays(mesh).draw_list(), options), options, 0.2, 0.2);
  CHECK(nearest_quarter(p[0], p[1], p[2]) == 1);
}

TEST_CASE("any bytes behind a signature are an image or a reason") {
  const std::vector<std::byte> png = *quarters_png().bytes;
  const std::vector<std::byte> jpeg = jpeg_of(*decode_image(png));
  for (const std::vector<std::byte>& good : {png, jpeg}) {
    for (std::size_t i = 3; i < good.size(); ++i) {
      std::vector<std::byte> bad = good;
      bad[i] ^= std::byte(0x55);
      const Result<Image> flipped = decode_image(bad);
      if (!flipped.ok()) CHECK(!flipped.failure().message.empty());
      bad.resize(i);
      const Result<Image> cut = decode_image(bad);
      if (!cut.ok()) CHECK(!cut.failure().message.empty());
    }
  }
}

TEST_CASE("images of few sizes stay as they are, those of many become four arrays that fit") {
  const PixelSize four[] = {{64, 64}, {32, 16}, {64, 64}, {5, 7}, {1000, 1000}};
  const TexturePlan kept = plan_textures(four, {});
  CHECK(kept.size_of_array == std::vector<PixelSize>{{64, 64}, {32, 16}, {5, 7}, {1000, 1000}});
  CHECK(kept.layers_of_array == std::vector<int>{2, 1, 1, 1});
  CHECK(kept.place_of_image[2] == TexturePlace{0, 1});

  std::vector<PixelSize> many;
  for (int i = 1; i < 300; ++i) many.push_back({7 * i % 301 + 1, 11 * i % 307 + 1});
  const TexturePlan merged = plan_textures(many, {});
  CHECK(merged.size_of_array.size() == 4);
  for (std::size_t i = 0; i < many.size(); ++i) {
    const TexturePlace& place = merged.place_of_image[i];
    REQUIRE(place.array >= 0);
    CHECK(merged.size_of_array[std::size_t(place.array)].width >= many[i].width);
    CHECK(merged.size_of_array[std::size_t(place.array)].height >= many[i].height);
    CHECK(place.layer < merged.layers_of_array[std::size_t(place.array)]);
  }

  const std::vector<PixelSize> large(40, {8192, 8192});
  const TexturePlan halved = plan_textures(large, {});
  CHECK(halved.size_of_array == std::vector<PixelSize>{{2048, 2048}});
  const TexturePlan few = plan_textures(large, {.max_side = 512, .max_layers = 30});
  CHECK(few.size_of_array == std::vector<PixelSize>{{512, 512}});
  CHECK(few.layers_of_array == std::vector<int>{30});
  CHECK(few.place_of_image[29] == TexturePlace{0, 29});
  CHECK(few.place_of_image[30] == TexturePlace{});
  CHECK(plan_textures({}, {}).size_of_array.empty());
}

}  // namespace crease
