// No light between triangles that share an edge, whichever parts of the draw list they are in.
//
// A gap in a closed model would show its far wall and not the background, so each model is cut down
// to the triangles that face the viewer: behind a gap there is then the light background.
#include "render/draw_arrays.h"
#include "render/layout.h"
#include "render/pixels.h"
#include "support/mesh_zoo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace crease {

namespace {

constexpr int kViews = 50, kColumns = 10, kCell = 120;

Camera fixed_camera() {
  Camera camera;
  camera.position = {0, -6, 0};
  camera.vertical_fov_deg = 28;
  camera.width_px = camera.height_px = kCell;
  return camera;
}

struct Rotation {
  Vec3d x, y, z;
  Vec3d operator()(const Vec3d& p) const { return x * p.x + y * p.y + z * p.z; }
};

Rotation random_rotation(std::mt19937& random) {
  const auto number = [&] { return double(random()) / 4294967296.0 * 2 - 1; };
  const Vec3d x = normalized(Vec3d{number(), number(), number()});
  const Vec3d y = normalized(cross(x, Vec3d{number(), number(), number() + 3}));
  return {x, y, cross(x, y)};
}

// Turned round the middle of its box, which comes to the origin, and scaled into the unit sphere.
Mesh turned(Mesh mesh, const Rotation& rotation) {
  Vec3d low = mesh.positions[0], high = low;
  for (const Vec3d& p : mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3d middle = (low + high) * 0.5;
  for (Vec3d& p : mesh.positions) p = rotation(p - middle) * (2 / length(high - low));
  AttributeLayer& normals = *mesh.normals();
  for (std::size_t i = 0; i < normals.values.size(); i += 3) {
    const Vec3d n = rotation({normals.values[i], normals.values[i + 1], normals.values[i + 2]});
    for (int c = 0; c < 3; ++c) normals.values[i + std::size_t(c)] = float(n[c]);
  }
  return mesh;
}

Mesh keep_if(const Mesh& mesh, const std::function<bool(std::size_t)>& keep) {
  Mesh kept = mesh;
  kept.triangles.clear();
  for (AttributeLayer& layer : kept.layers) layer.of_corner.clear();
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (!keep(t)) continue;
    kept.triangles.push_back(mesh.triangles[t]);
    for (std::size_t l = 0; l < mesh.layers.size(); ++l) {
      for (std::size_t c = 0; c < 3; ++c) {
        kept.layers[l].of_corner.push_back(mesh.layers[l].of_corner[3 * t + c]);
      }
    }
  }
  return kept;
}

Vec3d corner(const Mesh& mesh, std::size_t t, std::size_t c) {
  return mesh.positions[index_of(mesh.triangles[t][c])];
}

Vec3d scaled_normal(const Mesh& mesh, std::size_t t) {
  return cross(corner(mesh, t, 1) - corner(mesh, t, 0), corner(mesh, t, 2) - corner(mesh, t, 0));
}

Mesh facing_side(const Mesh& mesh) {
  return keep_if(mesh, [&](std::size_t t) {
    return dot(scaled_normal(mesh, t), fixed_camera().position - corner(mesh, t, 0)) > 0;
  });
}

// Whether the pixel looks at a triangle of the convex mesh well away from its silhouette: all four
// neighbours at two pixels' distance look at facing triangles too.
std::vector<bool> interior(const Mesh& facing) {
  std::vector<bool> hit(kCell * kCell);
  const Camera camera = fixed_camera();
  for (std::size_t t = 0; t < facing.triangle_count(); ++t) {
    std::array<std::array<double, 2>, 3> p;
    for (std::size_t c = 0; c < 3; ++c) p[c] = project(camera, corner(facing, t, c));
    const auto side = [](const auto& a, const auto& b, double x, double y) {
      return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    };
    const auto [x0, x1] = std::minmax({p[0][0], p[1][0], p[2][0]});
    const auto [y0, y1] = std::minmax({p[0][1], p[1][1], p[2][1]});
    for (int y = std::max(0, int(y0)); y <= std::min(kCell - 1, int(y1)); ++y) {
      for (int x = std::max(0, int(x0)); x <= std::min(kCell - 1, int(x1)); ++x) {
        const double px = x + 0.5, py = y + 0.5, slack = 1e-9;
        const double a = side(p[0], p[1], px, py), b = side(p[1], p[2], px, py),
                     c = side(p[2], p[0], px, py);
        if ((a >= -slack && b >= -slack && c >= -slack) ||
            (a <= slack && b <= slack && c <= slack)) {
          hit[std::size_t(y * kCell + x)] = true;
        }
      }
    }
  }
  std::vector<bool> inside(hit.size());
  for (int y = 2; y < kCell - 2; ++y) {
    for (int x = 2; x < kCell - 2; ++x) {
      bool all = true;
      for (int d = -2; d <= 2; ++d) {
        all &= hit[std::size_t(y * kCell + x + d)] && hit[std::size_t((y + d) * kCell + x)];
      }
      inside[std::size_t(y * kCell + x)] = all;
    }
  }
  return inside;
}

struct Found {
  int leaks = 0, pixels = 0;
};

// The surface's colour has little green, the background much. A pixel is suspect when it is greener
// than both pixels beside it or both above and below. So is the tip of a bright face between two
// dark ones; a leak is also greener than all around it that is not suspect.
// `whole` are the models as they should be.
Found find_leaks(const std::vector<Mesh>& models, const std::vector<Mesh>& whole) {
  std::vector<DrawArrays> arrays;
  for (const Mesh& mesh : models) arrays.emplace_back(mesh);
  std::vector<Panel> panels;
  for (const DrawArrays& a : arrays) {
    panels.push_back({.list = a.list(), .title = "", .level_share = 1});
  }
  LayoutRequest request{.panel_count = panels.size(),
                        .width_px = kColumns * (kCell + 2) - 2,
                        .height_px = 0,
                        .columns = kColumns,
                        .legend = true};
  // The height that gives square views; the legend's depends on it.
  const int rows = int(panels.size()) / kColumns;
  for (request.height_px = rows * kCell;; ++request.height_px) {
    if (make_layout(request).views[0].height == kCell) break;
    REQUIRE(request.height_px < 2 * rows * kCell);
  }
  const Layout layout = make_layout(request);
  RenderOptions options;
  options.width_px = request.width_px;
  options.height_px = request.height_px;
  options.columns = kColumns;
  options.camera = fixed_camera();
  options.coloring = Coloring::Level;  // one colour, dark in green
  const Result<Image> image = render_panels(panels, options);
  if (!image.ok()) FAIL(image.failure().message);

  Found found;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const PixelRect& view = layout.views[i];
    REQUIRE(view.width >= kCell);
    REQUIRE(view.height == kCell);
    const int shift = (view.width - kCell) / 2;
    const std::vector<bool> inside = interior(whole[i]);
    const auto green = [&](int x, int y) {
      return pixel_at(*image, view.x + shift + x, view.y + y)[1];
    };
    std::vector<bool> suspect(inside.size());
    for (int y = 1; y + 1 < kCell; ++y) {
      for (int x = 1; x + 1 < kCell; ++x) {
        if (!inside[std::size_t(y * kCell + x)]) continue;
        ++found.pixels;
        const int level = std::max(green(x - 1, y), green(x + 1, y));
        const int upright = std::max(green(x, y - 1), green(x, y + 1));
        suspect[std::size_t(y * kCell + x)] = green(x, y) > std::min(level, upright) + 6;
      }
    }
    for (int y = 2; y + 2 < kCell; ++y) {
      for (int x = 2; x + 2 < kCell; ++x) {
        if (!suspect[std::size_t(y * kCell + x)]) continue;
        int around = 0;
        for (int v = y - 2; v <= y + 2; ++v) {
          for (int u = x - 2; u <= x + 2; ++u) {
            if (!suspect[std::size_t(v * kCell + u)]) around = std::max(around, green(u, v));
          }
        }
        found.leaks += green(x, y) > around + 6;
      }
    }
  }
  return found;
}

}  // namespace

TEST_CASE("the background never shows between the triangles of a closed model") {
  const std::pair<const char*, Mesh> closed[] = {{"smooth sphere", smooth_sphere(12, 24)},
                                                 {"box", hard_box(4)},
                                                 {"cylinder", hard_cylinder(24, 4)}};
  for (const auto& [shape, mesh] : closed) {
    const std::string name = shape;
    CAPTURE(name);
    std::mt19937 random(7);
    std::vector<Mesh> models;
    for (int i = 0; i < kViews; ++i) {
      models.push_back(facing_side(turned(mesh, random_rotation(random))));
    }
    const Found found = find_leaks(models, models);
    CHECK(found.pixels > kViews * 1000);
    CHECK(found.leaks == 0);
  }
}

TEST_CASE("a gap of half a pixel would have been found") {
  std::mt19937 random(7);
  std::vector<Mesh> models, whole;
  for (int i = 0; i < kColumns; ++i) {
    Mesh mesh = turned(smooth_sphere(12, 24), random_rotation(random));
    mesh = facing_side(mesh);
    whole.push_back(mesh);
    // One triangle near the middle shrinks a little towards its barycentre.
    std::size_t nearest = 0;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      if (corner(mesh, t, 0).y < corner(mesh, nearest, 0).y) nearest = t;
    }
    const Vec3d middle =
        (corner(mesh, nearest, 0) + corner(mesh, nearest, 1) + corner(mesh, nearest, 2)) *
        (1.0 / 3);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d p = corner(mesh, nearest, c);
      const double pixel = 2 * 6 * std::tan(radians(14)) / kCell;
      mesh.triangles[nearest][c] = VertexId(std::uint32_t(mesh.vertex_count()));
      mesh.positions.push_back(p + normalized(middle - p) * pixel);
    }
    models.push_back(std::move(mesh));
  }
  CHECK(find_leaks(models, whole).leaks > 3 * kColumns);
}

}  // namespace crease
