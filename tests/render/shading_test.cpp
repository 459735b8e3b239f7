// What the three parts look like: flat where one normal is stored, smooth where it is shared.
#include "render/draw_arrays.h"
#include "render/pixels.h"
#include "support/mesh_builder.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace crease {

namespace {

constexpr int kSide = 320;

RenderOptions look_at(const Vec3d& position, const Vec3d& target) {
  Camera camera;
  camera.position = position;
  camera.target = target;
  camera.vertical_fov_deg = 40;
  camera.width_px = camera.height_px = kSide;
  RenderOptions options;
  options.width_px = options.height_px = kSide;
  options.camera = camera;
  return options;
}

Pixel pixel_of(const Image& image, const RenderOptions& options, const Vec3d& p) {
  const auto [x, y] = project(*options.camera, p);
  REQUIRE(x >= 0);
  REQUIRE(y >= 0);
  REQUIRE(x < image.width);
  REQUIRE(y < image.height);
  return pixel_at(image, int(x), int(y));
}

// The largest difference of neighbouring pixels in a disc around the middle.
int roughness(const Image& image, double radius_px) {
  int largest = 0;
  for (int y = 0; y + 1 < image.height; ++y) {
    for (int x = 0; x + 1 < image.width; ++x) {
      if (std::hypot(x - image.width / 2.0, y - image.height / 2.0) > radius_px) continue;
      const Pixel here = pixel_at(image, x, y);
      largest = std::max({largest, difference(here, pixel_at(image, x + 1, y)),
                          difference(here, pixel_at(image, x, y + 1))});
    }
  }
  return largest;
}

double radius_px(const RenderOptions& options) {  // of the unit sphere at the origin
  const auto middle = project(*options.camera, {0, 0, 0}),
             top = project(*options.camera, {0, 0, 1});
  return std::hypot(top[0] - middle[0], top[1] - middle[1]);
}

// A quad in the plane y = 0, from x = -1 to 1 and z = -1 to 1, seen from -y.
//
//   3---2    the lower right triangle comes first
//   | / |
//   0---1
Mesh quad(const std::function<void(MeshBuilder&, std::array<VertexId, 4>)>& add) {
  MeshBuilder b;
  add(b, {b.vertex({-1, 0, -1}), b.vertex({1, 0, -1}), b.vertex({1, 0, 1}), b.vertex({-1, 0, 1})});
  return b.take();
}

const RenderOptions kFromFront = look_at({0, -4, 0}, {0, 0, 0});

void turn_round(Mesh& mesh) {  // every triangle runs the other way, normals stay
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    for (AttributeLayer& layer : mesh.layers) {
      std::swap(layer.of_corner[3 * t + 1], layer.of_corner[3 * t + 2]);
    }
  }
}

}  // namespace

TEST_CASE("every side of a box has one colour exactly, and no two visible sides the same") {
  const DrawArrays box(hard_box(4));
  const RenderOptions options = look_at({2.2, -2.0, 2.4}, {0.5, 0.5, 0.5});
  const Image image = draw(box.list(), options);
  const std::function<Vec3d(double, double)> sides[] = {[](double u, double v) {
                                                          return Vec3d{u, v, 1};
                                                        },
                                                        [](double u, double v) {
                                                          return Vec3d{u, 0, v};
                                                        },
                                                        [](double u, double v) {
                                                          return Vec3d{1, u, v};
                                                        }};
  std::vector<Pixel> seen;
  for (const auto& side : sides) {
    const Pixel middle = pixel_of(image, options, side(0.5, 0.5));
    int unequal = 0;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60; ++j) {
        const Vec3d p = side(0.05 + 0.9 * i / 60, 0.05 + 0.9 * j / 60);
        unequal += pixel_of(image, options, p) != middle;
      }
    }
    CHECK(unequal == 0);
    for (const Pixel& other : seen) CHECK(difference(middle, other) > 12);
    seen.push_back(middle);
  }
}

TEST_CASE("a coarse sphere with shared normals is shaded as a fine one") {
  const RenderOptions options = look_at({0, -4, 1}, {0, 0, 0});
  const double inside = 0.85 * radius_px(options);
  const DrawArrays coarse(smooth_sphere(12, 24)), fine(smooth_sphere(120, 240));
  const DrawArrays facets(faceted_sphere(12, 24));
  const Image coarse_image = draw(coarse.list(), options), fine_image = draw(fine.list(), options);
  CHECK(roughness(coarse_image, inside) <= 4);
  CHECK(roughness(draw(facets.list(), options), inside) > 10);  // what a facet would measure

  int worst = 0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (std::hypot(x - kSide / 2.0, y - kSide / 2.0) > inside) continue;
      worst = std::max(worst, difference(pixel_at(coarse_image, x, y), pixel_at(fine_image, x, y)));
    }
  }
  CHECK(worst <= 6);
}

TEST_CASE("a cylinder has a flat cap, a smooth side and a hard rim between them") {
  const DrawArrays cylinder(hard_cylinder(40, 3));
  const RenderOptions options = look_at({0, -5, 4.5}, {0, 0, 1});
  const Image image = draw(cylinder.list(), options);
  const Pixel cap = pixel_of(image, options, {0, 0, 2});
  for (int i = 0; i < 40; ++i) {
    for (const double radius : {0.3, 0.6, 0.9}) {
      const double angle = 2 * kPi * i / 40;
      CHECK(pixel_of(image, options, {radius * std::cos(angle), radius * std::sin(angle), 2}) ==
            cap);
    }
  }
  Pixel before{};
  for (int i = 0; i <= 200; ++i) {  // along the side, facing the viewer
    const double angle = -kPi / 2 + 1.1 * (i - 100) / 100;
    const Pixel here = pixel_of(image, options, {std::cos(angle), std::sin(angle), 1});
    if (i > 0) CHECK(difference(here, before) <= 3);
    before = here;
  }
  CHECK(difference(cap, pixel_of(image, options, {0, -1, 1.9})) > 10);
}

TEST_CASE("a triangle is shaded by the normal it stores and not by its plane") {
  // The two triangles of a flat quad store different normals: one flat colour each.
  const Mesh split = quad([](MeshBuilder& b, std::array<VertexId, 4> v) {
    b.triangle({v[0], v[1], v[2]}, b.normal({0.6, -0.8, 0}));
    b.triangle({v[0], v[2], v[3]}, b.normal({-0.6, -0.6, 0.5}));
  });
  const DrawArrays arrays(split);
  REQUIRE(arrays.list().fn.triangle_count() == 2);
  REQUIRE(arrays.list().fn.normals.size() == 2);
  const Image image = draw(arrays.list(), kFromFront);
  const Pixel lower = pixel_of(image, kFromFront, {0.5, 0, -0.5});
  const Pixel upper = pixel_of(image, kFromFront, {-0.5, 0, 0.5});
  CHECK(difference(lower, upper) > 20);
  for (double d = -0.9; d <= 0.85; d += 0.05) {
    CHECK(pixel_of(image, kFromFront, {d + 0.08, 0, d}) == lower);
    CHECK(pixel_of(image, kFromFront, {d, 0, d + 0.08}) == upper);
  }
}

TEST_CASE("three normals of a triangle are blended between its corners") {
  // The left edge leans to the left, the right edge to the right, and no corner shares with the
  // other triangle.
  const Mesh bent = quad([](MeshBuilder& b, std::array<VertexId, 4> v) {
    const auto left = [&] { return b.normal({-0.7, -0.7, 0}); };
    const auto right = [&] { return b.normal({0.7, -0.7, 0}); };
    b.triangle({v[0], v[1], v[2]}, {left(), right(), right()});
    b.triangle({v[0], v[2], v[3]}, {left(), right(), left()});
  });
  const DrawArrays arrays(bent);
  REQUIRE(arrays.list().nsn.triangle_count() == 2);
  const Image image = draw(arrays.list(), kFromFront);
  const Pixel left = pixel_of(image, kFromFront, {-0.95, 0, 0});
  const Pixel right = pixel_of(image, kFromFront, {0.95, 0, 0});
  CHECK(left[0] > right[0] + 20);
  Pixel before = left;
  for (double x = -0.95; x <= 0.95; x += 0.01) {
    const Pixel here = pixel_of(image, kFromFront, {x, 0, 0});
    CHECK(difference(here, before) <= 4);
    before = here;
  }
}

TEST_CASE("surfaces look the same from behind and when their triangles run the other way") {
  const RenderOptions options = look_at({2.5, -3, 2}, {0, 0, 1});
  Mesh mesh = hard_cylinder(24, 3);
  const Image image = draw(DrawArrays(mesh).list(), options);
  // Interpolation starts from other corners then, so the last bit may differ.
  const auto differing = [&] {
    const Image other = draw(DrawArrays(mesh).list(), options);
    int count = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        count += difference(pixel_at(image, x, y), pixel_at(other, x, y)) > 2;
      }
    }
    return count;
  };
  turn_round(mesh);
  CHECK(differing() < 10);
  for (float& component : mesh.layers[0].values) component = -component;
  CHECK(differing() < 10);
}

TEST_CASE("kinds are coloured as the legend says") {
  const DrawArrays cylinder(hard_cylinder(40, 4));  // rims NSN, middle rings SN, caps FN
  RenderOptions options = look_at({0, -5, 4.5}, {0, 0, 1});
  options.coloring = Coloring::Kind;
  options.height_px += 40;  // the legend's strip makes the view shorter; then it is larger again
  const Image image = draw(cylinder.list(), options);
  const auto found = [&](const ColorSrgb& color) {
    int count = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) count += same_hue(pixel_at(image, x, y), color);
    }
    return count;
  };
  CHECK(found(kind_color(TriangleKind::SN)) > 1000);
  CHECK(found(kind_color(TriangleKind::FN)) > 1000);
  CHECK(found(kind_color(TriangleKind::NSN)) > 1000);

  // Down the middle of the picture: cap, upper rim, middle, lower rim.
  std::vector<TriangleKind> order;
  for (int y = 0; y < kSide; ++y) {
    for (const TriangleKind kind : {TriangleKind::SN, TriangleKind::FN, TriangleKind::NSN}) {
      const bool here = same_hue(pixel_at(image, kSide / 2, y), kind_color(kind));
      if (here && (order.empty() || order.back() != kind)) order.push_back(kind);
    }
  }
  CHECK(order == std::vector<TriangleKind>{TriangleKind::FN, TriangleKind::NSN, TriangleKind::SN,
                                           TriangleKind::NSN});
}

TEST_CASE("errors are blue where small and red where large, on one scale") {
  const Mesh flat = quad([](MeshBuilder& b, std::array<VertexId, 4> v) {
    b.quad(v, b.normal({0, -1, 0}));
  });
  const DrawArrays arrays(flat);
  const std::array<float, 4> small{0, 0, 0, 0}, large{0, 2, 2, 0};
  const Panel panels[] = {{.list = arrays.list(), .title = "", .error_of_position = small},
                          {.list = arrays.list(), .title = "", .error_of_position = large}};
  RenderOptions options = kFromFront;
  options.coloring = Coloring::Error;
  options.width_px = 2 * kSide;
  options.columns = 2;
  const Result<Image> image = render_panels(panels, options);
  REQUIRE(image.ok());
  const int y = kSide / 2;
  CHECK(same_hue(pixel_at(*image, kSide / 2, y), error_color(0)));
  CHECK(same_hue(pixel_at(*image, 3 * kSide / 2 - 80, y), error_color(0.08f)));
  CHECK(same_hue(pixel_at(*image, 3 * kSide / 2 + 80, y), error_color(0.92f)));
}

TEST_CASE("levels have their own colours") {
  const DrawArrays sphere(smooth_sphere(12, 24));
  RenderOptions options = look_at({0, -4, 0}, {0, 0, 0});
  options.coloring = Coloring::Level;
  for (const float share : {0.0f, 0.5f, 1.0f}) {
    const Panel panel{.list = sphere.list(), .title = "", .level_share = share};
    const Result<Image> image = render_panels(std::span(&panel, 1), options);
    REQUIRE(image.ok());
    CHECK(same_hue(pixel_at(*image, kSide / 2, kSide / 3), level_color(share)));
  }
}

TEST_CASE("where levels differ, each position has the colour of its own") {
  const DrawArrays sphere(smooth_sphere(12, 24));
  const DrawList list = sphere.list();
  std::vector<float> levels;
  for (const Vec3f& p : list.positions) levels.push_back(p.z + float(list.origin.z) > 0 ? 1 : 0);
  RenderOptions options = look_at({0, -4, 0}, {0, 0, 0});
  for (const bool wireframe : {false, true}) {  // indexed and pulled
    options.wireframe = wireframe;
    options.coloring = Coloring::Level;
    const Panel panel{.list = list, .title = "", .level_share = 0.5f, .level_of_position = levels};
    const Result<Image> image = render_panels(std::span(&panel, 1), options);
    REQUIRE(image.ok());
    CHECK(same_hue(pixel_at(*image, kSide / 2 + 6, kSide / 3), level_color(1)));
    CHECK(same_hue(pixel_at(*image, kSide / 2 + 6, 2 * kSide / 3), level_color(0)));
  }
  levels.pop_back();
  const Panel panel{.list = list, .title = "", .level_of_position = levels};
  CHECK(!render_panels(std::span(&panel, 1), options).ok());
}

TEST_CASE("materials colour triangles, colours of corners are blended") {
  Mesh mesh = quad([](MeshBuilder& b, std::array<VertexId, 4> v) {
    b.quad(v, b.normal({0, -1, 0}));
  });
  Material red, blue;
  red.base_color = {0.7f, 0.1f, 0.1f, 1};
  blue.base_color = {0.1f, 0.1f, 0.7f, 1};
  mesh.materials = {red, blue};
  mesh.material_of_triangle = {MaterialId{0}, MaterialId{1}};
  const DrawArrays by_material(mesh);
  Image image = draw(by_material.list(), kFromFront);
  const Pixel lower = pixel_of(image, kFromFront, {0.5, 0, -0.5});
  const Pixel upper = pixel_of(image, kFromFront, {-0.5, 0, 0.5});
  CHECK(lower[0] > 2 * lower[2]);
  CHECK(upper[2] > 2 * upper[0]);

  mesh.material_of_triangle.clear();
  AttributeLayer colors;  // green on the left, red on the right
  colors.name = "color";
  colors.role = AttributeRole::Color;
  colors.dimension = 3;
  colors.values = {0, 1, 0, 1, 0, 0};
  colors.of_corner = {AttributeId{0}, AttributeId{1}, AttributeId{1},
                      AttributeId{0}, AttributeId{1}, AttributeId{0}};
  mesh.layers.push_back(colors);
  const DrawArrays by_corner(mesh);
  image = draw(by_corner.list(), kFromFront);
  const Pixel left = pixel_of(image, kFromFront, {-0.95, 0, 0});
  const Pixel middle = pixel_of(image, kFromFront, {0.02, 0, 0});
  const Pixel right = pixel_of(image, kFromFront, {0.95, 0, 0});
  CHECK(left[1] > 2 * left[0]);
  CHECK(right[0] > 2 * right[1]);
  CHECK(std::abs(middle[0] - middle[1]) < 30);
}

TEST_CASE("a wireframe darkens the edges in front and shows none behind") {
  RenderOptions options = look_at({0.5, -3, 0.5}, {0.5, 0.5, 0.5});  // into one side of the box
  const DrawArrays box(hard_box(1));
  const Image plain = draw(box.list(), options);
  options.wireframe = true;
  const Image wired = draw(box.list(), options);
  const auto darker = [&](const Vec3d& p) {
    return pixel_of(plain, options, p)[0] - pixel_of(wired, options, p)[0];
  };
  // The diagonal is an edge, whichever of the two it is; the middles of the triangles are not.
  const int one = darker({0.75, 0, 0.75}), other = darker({0.75, 0, 0.25});
  CHECK(std::max(one, other) > 60);
  CHECK(std::min(one, other) <= 1);
  // The back side's edges lie inside the front side in this view, at 3/4 of its size.
  int dark = 0;
  for (int i = 0; i < 200; ++i) {
    const double u = 0.06 + 0.88 * i / 200;
    dark += darker({u, 0, one > other ? 0.5 * u : 0.5 + 0.45 * u}) > 60;
  }
  CHECK(dark <= 3);  // where the diagonal is crossed
}

TEST_CASE("a normal across its triangle is not turned by rounding") {
  const Vec3d right = normalized(Vec3d{1, 0.37, 0.2}), up = normalized(cross(right, {0.3, 1, 0.1}));
  const Vec3d away = cross(right, up);
  MeshBuilder b;
  const AttributeId across = b.normal_at(up);
  b.quad({b.vertex((right + up) * -1.0), b.vertex(right - up), b.vertex(right + up),
          b.vertex(up - right)},
         across);
  const Mesh mesh = b.take();
  const MeshDrawArrays arrays(mesh);
  for (const double side : {-4.0, 4.0}) {
    const RenderOptions options = look_at(away * side, {0, 0, 0});
    CHECK(roughness(draw(arrays.draw_list(), options), 60) < 4);
  }
}

// As large as 1e-30 or 1e27: squares of such lengths are no floats any more.
TEST_CASE("a model has the same picture in whatever unit its lengths are") {
  const auto picture_of = [](double unit, bool has_frustum) {
    Mesh mesh = hard_box(3);
    for (Vec3d& p : mesh.positions) p = p * unit;
    const MeshDrawArrays arrays(mesh);
    RenderOptions options = look_at(Vec3d{3, -4, 3} * unit, Vec3d{0.5, 0.5, 0.5} * unit);
    options.ambient_occlusion = true;
    options.wireframe = true;
    if (has_frustum) {
      options.frustum = options.camera;
      options.camera.reset();
    }
    return draw(arrays.draw_list(), options);
  };
  for (const bool has_frustum : {false, true}) {
    const Image picture = picture_of(1, has_frustum);
    CHECK(roughness(picture, kSide) > 30);  // the box is there
    for (const int exponent : {-100, -60, 60, 90}) {
      CAPTURE(exponent);
      CHECK(picture_of(std::ldexp(1.0, exponent), has_frustum).rgba == picture.rgba);
    }
  }
}

TEST_CASE("of two sides at one place the one that faces the eye is seen") {
  Mesh mesh = quad([](MeshBuilder& b, const std::array<VertexId, 4>& v) {
    b.flat_triangle({v[1], v[0], v[2]});  // to +y, and first
    b.flat_triangle({v[3], v[2], v[0]});
    b.flat_triangle({v[0], v[1], v[2]});  // to -y
    b.flat_triangle({v[0], v[2], v[3]});
  });
  mesh.materials = {{"back", {0.02F, 0.02F, 1, 1}, ""}, {"front", {1, 0.02F, 0.02F, 1}, ""}};
  mesh.material_of_triangle = {MaterialId{0}, MaterialId{0}, MaterialId{1}, MaterialId{1}};
  const MeshDrawArrays arrays(mesh);
  for (const double y : {-4.0, 4.0}) {
    for (const double x : {-3.0, -0.3, 0.0, 2.0}) {
      for (const double distance : {0.5, 1.0, 40.0}) {
        CAPTURE(x);
        CAPTURE(y);
        CAPTURE(distance);
        RenderOptions options = look_at(Vec3d{x, y, 1} * distance, {0, 0, 0});
        options.camera->vertical_fov_deg /= distance;
        const Image image = draw(arrays.draw_list(), options);
        for (int i = 0; i < 100; ++i) {
          const Vec3d p{0.18 * (i % 10) - 0.81, 0, 0.18 * int(i / 10) - 0.81};
          const Pixel pixel = pixel_of(image, options, p);
          CHECK(pixel[y < 0 ? 0 : 2] > 2 * pixel[y < 0 ? 2 : 0]);
        }
      }
    }
  }
}

}  // namespace crease
