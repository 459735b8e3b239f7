#include "render/draw_arrays.h"
#include "render/layout.h"
#include "render/pixels.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace crease {

namespace {

int count_dark(const Image& image, const PixelRect& rect) {
  int count = 0;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) count += pixel_at(image, x, y)[0] < 120;
  }
  return count;
}

// Neither the page nor the background is as dark as a surface, or as saturated.
bool is_surface(const Pixel& pixel) {
  return pixel[2] < 216;
}

int count_surface(const Image& image, const PixelRect& rect) {
  int count = 0;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      count += is_surface(pixel_at(image, x, y));
    }
  }
  return count;
}

RenderOptions size(int width, int height) {
  RenderOptions options;
  options.width_px = width;
  options.height_px = height;
  return options;
}

}  // namespace

TEST_CASE("each panel shows its own list under its own title") {
  const DrawArrays sphere(smooth_sphere(16, 32)), box(hard_box(2));
  const Panel panels[] = {{.list = sphere.list(), .title = "left"},
                          {.list = DrawList{}, .title = ""},
                          {.list = box.list(), .title = "right"}};
  RenderOptions options = size(600, 260);
  options.columns = 3;
  const Result<Image> image = render_panels(panels, options);
  REQUIRE(image.ok());
  REQUIRE(image->width == 600);
  REQUIRE(image->height == 260);
  const Layout layout = make_layout(
      {.panel_count = 3, .width_px = 600, .height_px = 260, .columns = 3, .titles = true});
  CHECK(count_surface(*image, layout.views[0]) > 5000);
  CHECK(count_surface(*image, layout.views[1]) == 0);
  CHECK(count_surface(*image, layout.views[2]) > 800);
  CHECK(count_dark(*image, layout.titles[0]) > 20);
  CHECK(count_dark(*image, layout.titles[1]) == 0);
  CHECK(count_dark(*image, layout.titles[2]) > 20);
  REQUIRE(layout.separators.size() == 2);
  for (const PixelRect& line : layout.separators) {
    const Pixel expected{kSeparatorColor[0], kSeparatorColor[1], kSeparatorColor[2]};
    CHECK(pixel_at(*image, line.x, line.y) == expected);
    CHECK(pixel_at(*image, line.x, line.y + line.height - 1) == expected);
  }
}

TEST_CASE("models that lie apart are each seen from near, levels of one from one place") {
  Mesh far_box = hard_box(2), near_box = hard_box(2);
  for (Vec3d& p : far_box.positions) p += Vec3d{1e4, 5e3, 0};
  for (Vec3d& p : near_box.positions) p = p * 0.6;
  const DrawArrays box(hard_box(2)), far(far_box), small(near_box);
  Panel panels[] = {{.list = box.list(), .title = "", .model = 0},
                    {.list = far.list(), .title = "", .model = 1},
                    {.list = small.list(), .title = "", .model = 2}};
  RenderOptions options = size(600, 200);
  options.columns = 3;
  std::vector<std::string> notes;
  options.on_note = [&notes](const std::string& note) { notes.push_back(note); };
  const Result<Image> image = render_panels(panels, options);
  REQUIRE(image.ok());
  CHECK(notes.size() == 1);
  const Layout layout =
      make_layout({.panel_count = 3, .width_px = 600, .height_px = 200, .columns = 3});
  const int whole = count_surface(*image, layout.views[0]);
  CHECK(whole > 5000);
  CHECK(std::abs(count_surface(*image, layout.views[1]) - whole) < whole / 100);
  const int small_count = count_surface(*image, layout.views[2]);
  CHECK(small_count > whole / 5);
  CHECK(small_count < whole / 2);

  panels[1].model = 0;  // one model, wherever its parts are
  const Result<Image> together = render_panels(panels, options);
  REQUIRE(together.ok());
  CHECK(notes.size() == 2);  // the small one
  CHECK(count_surface(*together, layout.views[0]) < 100);

  options.camera = Camera{.position = {10, -10, 10}, .target = {0, 0, 0}};
  const Result<Image> asked = render_panels(panels, options);
  REQUIRE(asked.ok());
  CHECK(notes.size() == 2);
  CHECK(count_surface(*asked, layout.views[0]) > 50);
  CHECK(count_surface(*asked, layout.views[1]) == 0);
}

TEST_CASE("models with cameras of their own stand upright, each as its own axis is up") {
  Mesh z_up = hard_cylinder(24, 4);
  for (Vec3d& p : z_up.positions) p.z *= 3;
  Mesh y_up = z_up;
  for (Vec3d& p : y_up.positions) p = Vec3d{p.x + 1e4, p.z, -p.y};
  const DrawArrays left(z_up), right(y_up);
  Panel panels[] = {{.list = left.list(), .title = "", .model = 0, .up = Vec3d{0, 0, 1}},
                    {.list = right.list(), .title = "", .model = 1, .up = Vec3d{0, 1, 0}}};
  RenderOptions options = size(400, 200);
  options.columns = 2;
  const Layout layout =
      make_layout({.panel_count = 2, .width_px = 400, .height_px = 200, .columns = 2});
  const auto apart = [&] {
    const Result<Image> image = render_panels(panels, options);
    REQUIRE(image.ok());
    return count_surface(*image, layout.views[0]) - count_surface(*image, layout.views[1]);
  };
  CHECK(std::abs(apart()) < 100);
  panels[1].up.reset();  // else the picture's
  CHECK(std::abs(apart()) > 2000);
}

TEST_CASE("a legend stands below where colours mean something") {
  const DrawArrays cylinder(hard_cylinder(16, 3));
  for (const Coloring coloring : {Coloring::Kind, Coloring::Level, Coloring::Error}) {
    RenderOptions options = size(700, 300);
    options.coloring = coloring;
    const Image image = draw(cylinder.list(), options);
    const Layout layout =
        make_layout({.panel_count = 1, .width_px = 700, .height_px = 300, .legend = true});
    int colored = 0;
    for (int y = layout.legend.y; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) colored += saturation(pixel_at(image, x, y)) > 0.3;
    }
    CHECK(colored > 200);
    CHECK(count_dark(image, layout.legend) > 50);
  }
}

// The picture of one panel among others.
Image panel_of(const Image& image, const PixelRect& view) {
  Image panel;
  panel.width = view.width;
  panel.height = view.height;
  for (int y = 0; y < view.height; ++y) {
    const auto row = image.rgba.begin() + 4 * (std::ptrdiff_t(view.y + y) * image.width + view.x);
    panel.rgba.insert(panel.rgba.end(), row, row + 4 * view.width);
  }
  return panel;
}

TEST_CASE("a panel shows what the camera of its own shape sees") {
  const DrawArrays cylinder(hard_cylinder(24, 4));
  const Panel panels[] = {{.list = cylinder.list(), .title = "left"},
                          {.list = cylinder.list(), .title = "right"}};
  RenderOptions options = size(500, 300);
  Camera camera;
  camera.position = {1, -3, 2};
  camera.width_px = 400;
  camera.height_px = 300;
  options.camera = camera;
  for (const int columns : {1, 2}) {  // wider, and narrower than the camera's viewport
    CAPTURE(columns);
    options.columns = columns;
    const Result<Image> image = render_panels(panels, options);
    REQUIRE(image.ok());
    const Result<Camera> seen = camera_of_panel(2, true, options);
    REQUIRE(seen.ok());
    const Layout layout = make_layout(
        {.panel_count = 2, .width_px = 500, .height_px = 300, .columns = columns, .titles = true});
    CHECK(seen->width_px == layout.views[1].width);
    CHECK(seen->height_px == layout.views[1].height);
    CHECK((seen->vertical_fov_deg > 45.01) == (columns == 2));
    RenderOptions alone = size(seen->width_px, seen->height_px);
    alone.camera = *seen;
    const Image expected = draw(cylinder.list(), alone);
    const Image got = panel_of(*image, layout.views[1]);
    int apart = 0;
    for (int y = 0; y < got.height; ++y) {
      for (int x = 0; x < got.width; ++x) {
        apart += difference(pixel_at(expected, x, y), pixel_at(got, x, y)) > 2;
      }
    }
    CHECK(count_surface(got, {0, 0, got.width, got.height}) > 1000);
    CHECK(apart == 0);
  }
}

TEST_CASE("the same input gives the same picture") {
  const DrawArrays cylinder(hard_cylinder(24, 4));
  RenderOptions options = size(333, 222);
  options.wireframe = true;
  CHECK(draw(cylinder.list(), options).rgba == draw(cylinder.list(), options).rgba);
}

TEST_CASE("a model far from the origin looks as it does at the origin") {
  Mesh near = hard_cylinder(24, 4), far = near;
  for (Vec3d& p : far.positions) p += Vec3d{390000, 5819000, 34};
  const Image a = draw(DrawArrays(near).list(), size(300, 300));
  const Image b = draw(DrawArrays(far).list(), size(300, 300));
  int differing = 0;
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      differing += difference(pixel_at(a, x, y), pixel_at(b, x, y)) > 2;
    }
  }
  CHECK(differing < 20);
}

TEST_CASE("a picture wider than one tile has no seam") {
  const DrawArrays sphere(smooth_sphere(64, 128));
  Camera camera;
  camera.position = {-2.2, -6, 0};  // so that the sphere lies right of the middle
  camera.target = {-2.2, 0, 0};
  camera.vertical_fov_deg = 16;
  camera.width_px = 2600;
  camera.height_px = 500;
  RenderOptions options = size(2600, 500);
  options.camera = camera;
  const Image image = draw(sphere.list(), options);
  const double left = project(camera, {-1, 0, 0})[0], right = project(camera, {1, 0, 0})[0];
  REQUIRE(left < 2000);
  REQUIRE(right > 2100);
  int rows = 0;
  for (int y = 0; y < 500; ++y) {
    for (int x = 2030; x < 2070; ++x) {
      const Pixel a = pixel_at(image, x, y), b = pixel_at(image, x + 1, y);
      const bool inside = std::abs(y - 250) < 150;
      if (inside) CHECK(difference(a, b) <= 5);
      rows += inside && is_surface(a);
    }
  }
  CHECK(rows > 5000);
}

TEST_CASE("what cannot be drawn is refused with the panel and the reason") {
  const DrawArrays box(hard_box(1));
  const auto message = [](const Panel& panel) {
    const Result<Image> image = render_panels(std::span(&panel, 1), size(64, 64));
    return image.ok() ? std::string("drawn") : image.failure().message;
  };
  CHECK(render_panels({}, size(64, 64)).failure().error == Error::BadValue);
  Panel good{.list = box.list(), .title = "box"};
  CHECK(message(good) == "drawn");
  for (const auto& [width, height] :
       {std::pair(0, 64), std::pair(64, -1), std::pair(1 << 20, 64)}) {
    const Result<Image> image = render_panels(std::span(&good, 1), size(width, height));
    REQUIRE(!image.ok());
    CHECK(image.failure().error == Error::BadValue);
  }
  const std::vector<Panel> many(500, good);
  CHECK(!render_panels(many, size(40, 40)).ok());

  Panel bad = good;
  bad.list.positions = bad.list.positions.first(5);
  CHECK(message(bad).find("panel 1 (box): FN part: index") == 0);
  bad = good;
  bad.list.fn.normals = bad.list.fn.normals.first(3);
  CHECK(message(bad).find("normals do not fit") != std::string::npos);
  bad = good;
  const std::vector<std::uint32_t> materials(12, 7);
  const std::vector<Material> one(1);
  bad.list.fn.materials = materials;
  bad.list.materials = one;
  CHECK(message(bad).find("material 7 of 1") != std::string::npos);
  bad = good;
  const std::vector<float> errors(3);
  bad.error_of_position = errors;
  CHECK(message(bad).find("errors are not one a position") != std::string::npos);
}

TEST_CASE("the whole zoo can be drawn, in every way") {
  const std::vector<ZooMesh> zoo = mesh_zoo();
  std::vector<DrawArrays> arrays;
  for (const ZooMesh& z : zoo) arrays.emplace_back(z.mesh);
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < zoo.size(); ++i) {
    panels.push_back({.list = arrays[i].list(), .title = zoo[i].name});
  }
  for (const bool wireframe : {false, true}) {
    RenderOptions options = size(640, 480);
    options.wireframe = wireframe;
    const Result<Image> image = render_panels(panels, options);
    REQUIRE(image.ok());
    CHECK(count_surface(*image, {0, 0, 640, 480}) > 5000);
  }
}

}  // namespace crease
