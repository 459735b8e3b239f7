// What textures, colours and normals show on a surface is displaced on the screen by no more than a
// view allows, also where the surface itself is flat; measured on the plane, beside the functions
// that painted it.
#include "crease/adaptive_mesh.h"
#include "crease/build.h"
#include "crease/build_hierarchy.h"
#include "crease/build_progressive_arrays.h"
#include "crease/decode_model.h"
#include "crease/progressive_mesh.h"
#include "support/sanitized.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

namespace crease {
namespace {

constexpr std::uint32_t kCells = 80;
constexpr std::array kAllPlacements{Placement::Optimal, Placement::Endpoint};
constexpr std::span kPlacements{kAllPlacements.data(), kSanitized ? 1u : 2u};

using Paint = std::function<std::array<float, 3>(double x, double y)>;

// The unit square in z = 0.
Mesh flat_sheet(AttributeRole role, std::uint32_t dimension, const Paint& paint) {
  Mesh mesh;
  AttributeLayer normals{"normal", AttributeRole::Normal, Interpolation::Direction, 3, {}, {}};
  AttributeLayer painted{"paint", role, Interpolation::Linear, dimension, {}, {}};
  normals.values = {0, 0, 1};
  for (std::uint32_t j = 0; j <= kCells; ++j) {
    for (std::uint32_t i = 0; i <= kCells; ++i) {
      const double x = double(i) / kCells, y = double(j) / kCells;
      mesh.positions.push_back({x, y, 0});
      const std::array<float, 3> value = paint(x, y);
      painted.values.insert(painted.values.end(), value.begin(), value.begin() + dimension);
    }
  }
  for (std::uint32_t j = 0; j < kCells; ++j) {
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t a = j * (kCells + 1) + i, b = a + 1, c = b + kCells + 1, d = c - 1;
      for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}}) {
        mesh.triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        for (const std::uint32_t v : t) {
          painted.of_corner.push_back(AttributeId{v});
          normals.of_corner.push_back(AttributeId{0});
        }
      }
    }
  }
  mesh.layers = {std::move(normals), std::move(painted)};
  return mesh;
}

// What a file of the mesh has.
DecodedModel from_file(Mesh mesh, Placement placement) {
  BuildOptions options;
  options.simplify.placement = placement;
  const Result<Built> built = build_model(std::move(mesh), options);
  REQUIRE(built.ok());
  const Result<BlockFile> file = BlockFile::open(memory_source(built->file_bytes));
  REQUIRE(file.ok());
  Result<DecodedModel> model = decode_model(*file);
  REQUIRE(model.ok());
  return *std::move(model);
}

// From far above, so that a pixel is as long everywhere: `allowed`, of the unit square.
Mesh seen_from_above(Mesh mesh, double allowed, Placement placement) {
  const DecodedModel model = from_file(std::move(mesh), placement);
  Result<MeshHierarchy> hierarchy = build_hierarchy(model.mesh, model.sequence, {});
  REQUIRE(hierarchy.ok());
  AdaptiveMesh adaptive(std::make_shared<const MeshHierarchy>(std::move(*hierarchy)));
  Camera camera{.position = {0.5, 0.5, 100}, .target = {0.5, 0.5, 0}, .up = {0, 1, 0}};
  camera.vertical_fov_deg = 2;
  camera.width_px = camera.height_px = 1000;
  camera.pixels = allowed * 1000 / (2 * 100 * std::tan(radians(1.0)));
  adaptive.update({.camera = camera});
  return adaptive.extract();
}

struct Sample {
  double x, y, area;
  std::array<double, 3> value;
};

// Points all over a mesh, with what its last layer shows there.
std::vector<Sample> samples_of(const Mesh& mesh) {
  std::vector<Sample> samples;
  const AttributeLayer& paint = mesh.layers.back();
  constexpr int kSteps = kSanitized ? 8 : 24;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle& v = mesh.triangles[t];
    const auto at = [&](std::size_t c) { return mesh.positions[index_of(v[c])]; };
    const double area = length(cross(at(1) - at(0), at(2) - at(0))) / (kSteps * (kSteps + 1));
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; i + j < kSteps; ++j) {
        const double b = (i + 1 / 3.0) / kSteps, c = (j + 1 / 3.0) / kSteps, a = 1 - b - c;
        const Vec3d p = at(0) * a + at(1) * b + at(2) * c;
        Sample s{p.x, p.y, area, {}};
        for (std::size_t k = 0; k < paint.dimension; ++k) {
          const auto corner = [&](std::size_t at_corner) {
            return double(paint.value(paint.of_corner[3 * t + at_corner])[k]);
          };
          s.value[k] = a * corner(0) + b * corner(1) + c * corner(2);
        }
        samples.push_back(s);
      }
    }
  }
  return samples;
}

TEST_CASE("a texture that is warped on a flat sheet slides by what a view allows") {
  const Paint warped = [](double x, double y) {
    return std::array{static_cast<float>(3 * x + 0.15 * std::sin(9 * y)),
                      static_cast<float>(3 * y + 0.12 * std::sin(8 * x + 3 * y)), 0.0f};
  };
  for (const Placement placement : kPlacements) {
    for (const double allowed : {0.001, 0.003, 0.01}) {
      CAPTURE(allowed);
      const Mesh seen =
          seen_from_above(flat_sheet(AttributeRole::TexCoord, 2, warped), allowed, placement);
      double sum = 0, area = 0;
      for (const Sample& s : samples_of(seen)) {
        const std::array<float, 3> right = warped(s.x, s.y);
        const double u = s.value[0] - double(right[0]), v = s.value[1] - double(right[1]);
        sum += s.area * (u * u + v * v) / 9;  // three units are the square's side
        area += s.area;
      }
      CHECK(area == doctest::Approx(1).epsilon(0.02));
      CHECK(std::sqrt(sum / area) < allowed);
      CHECK(std::sqrt(sum / area) > allowed / 8);
      CHECK(seen.triangle_count() < kCells * kCells / 2);
    }
  }
}

TEST_CASE("a texture that lies straight on a flat sheet needs two triangles") {
  const Paint straight = [](double x, double y) {
    return std::array{static_cast<float>(x + y / 4), static_cast<float>(y - x / 8), 0.0f};
  };
  const Mesh seen =
      seen_from_above(flat_sheet(AttributeRole::TexCoord, 2, straight), 0.001, Placement::Optimal);
  CHECK(seen.triangle_count() <= 8);
}

// In two charts, left and right of x = 1/2, with an affine map each.
Mesh two_charts() {
  const auto left = [](double x, double y) {
    return std::array{static_cast<float>(0.4 * x), static_cast<float>(0.8 * y), 0.0f};
  };
  Mesh mesh = flat_sheet(AttributeRole::TexCoord, 2, left);
  AttributeLayer& paint = mesh.layers[1];
  const std::size_t count = mesh.vertex_count();
  for (std::size_t v = 0; v < count; ++v) {
    paint.values.push_back(paint.values[2 * v] + 0.5f);
    paint.values.push_back(paint.values[2 * v + 1] / 2);
  }
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    double x = 0;
    for (const VertexId v : mesh.triangles[t]) x += mesh.positions[index_of(v)].x / 3;
    if (x < 0.5) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      AttributeId& a = paint.of_corner[3 * t + c];
      a = AttributeId{static_cast<std::uint32_t>(index_of(a) + count)};
    }
  }
  return mesh;
}

// At most so far off where something is shown, at some levels of a file of the mesh: the mean over
// the sheet, and the worst place.
struct Off {
  double mean = 0, most = 0;
};
using OffAt = std::function<double(const Sample&)>;

std::vector<Off> off_at_levels(Mesh mesh, Placement placement, const OffAt& off_at) {
  const DecodedModel model = from_file(std::move(mesh), placement);
  ProgressiveMesh levels(build_progressive_arrays(model.mesh, model.sequence));
  std::vector<Off> all;
  for (const double share : {0.99, 0.9, 0.7, 0.4, 0.2, 0.1, 0.05, 0.01}) {
    levels.set_triangle_count(std::size_t(share * double(model.mesh.triangle_count())));
    Off& off = all.emplace_back();
    for (const Sample& s : samples_of(levels.extract())) {
      const double here = off_at(s);
      off.mean += s.area * here;
      off.most = std::max(off.most, here);
    }
  }
  return all;
}

TEST_CASE("a seam on a flat sheet moves no texture, at any level") {
  for (const Placement placement : kPlacements) {
    for (const Off& off : off_at_levels(two_charts(), placement, [](const Sample& s) {
           const bool is_left = s.value[0] < 0.45;
           const double u = is_left ? 0.4 * s.x : 0.5 + 0.4 * s.x;
           const double v = is_left ? 0.8 * s.y : 0.4 * s.y;
           return std::max(std::abs(s.value[0] - u), std::abs(s.value[1] - v));
         })) {
      CHECK(off.most < 1e-3);
    }
  }
}

TEST_CASE("a number that grows along a flat sheet goes on doing so") {
  const Paint slope = [](double x, double y) {
    return std::array{static_cast<float>(500 * x + 200 * y), 0.0f, 0.0f};
  };
  for (const Placement placement : kPlacements) {
    for (const Off& off : off_at_levels(
             flat_sheet(AttributeRole::Other, 1, slope), placement,
             [](const Sample& s) { return std::abs(s.value[0] - 500 * s.x - 200 * s.y) / 700; })) {
      CHECK(off.mean < 0.02);
    }
  }
}

TEST_CASE("a line between two colours on a flat sheet stays where a view needs it") {
  // A disc of a third of the side, as sharp as the cells are.
  const auto inside = [](double x, double y) {
    return std::clamp((1 / 3.0 - std::hypot(x - 0.5, y - 0.5)) * kCells + 0.5, 0.0, 1.0);
  };
  const Paint disc = [&](double x, double y) {
    const auto in = static_cast<float>(inside(x, y));
    return std::array{in, 0.25f, 1 - in};
  };
  std::size_t before = kCells * kCells * 2;
  for (const double allowed : {0.003, 0.01, 0.03}) {
    CAPTURE(allowed);
    const Mesh seen =
        seen_from_above(flat_sheet(AttributeRole::Color, 3, disc), allowed, Placement::Optimal);
    double wrong = 0;
    for (const Sample& s : samples_of(seen)) {
      wrong += s.area * std::abs(s.value[0] - inside(s.x, s.y));
    }
    const double along = 2 * kPi / 3;  // the line's length
    CHECK(wrong / along < allowed + 0.2 / kCells);
    CHECK(seen.triangle_count() < before);
    before = seen.triangle_count();
  }
  CHECK(before < kCells * kCells / 10);
}

TEST_CASE("normals that make a flat sheet look wavy are shown as waves") {
  const auto wavy = [](double x, double y) {
    return normalized(Vec3d{-0.5 * std::cos(20 * x), -0.5 * std::cos(20 * y), 1});
  };
  Mesh mesh = flat_sheet(AttributeRole::Other, 3, [&](double x, double y) {
    const Vec3d n = wavy(x, y);
    return std::array{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
  });
  AttributeLayer normals = std::move(mesh.layers[1]);
  normals.name = "normal";
  normals.role = AttributeRole::Normal;
  normals.interpolation = Interpolation::Direction;
  mesh.layers = {std::move(normals)};
  for (const Placement placement : kPlacements) {
    const Mesh seen = seen_from_above(mesh, 0.002, placement);
    double sum = 0, area = 0;
    for (const Sample& s : samples_of(seen)) {
      const Vec3d shown = normalized(Vec3d{s.value[0], s.value[1], s.value[2]});
      const double turned = degrees(std::acos(std::min(1.0, dot(shown, wavy(s.x, s.y)))));
      sum += s.area * turned * turned;
      area += s.area;
    }
    CHECK(std::sqrt(sum / area) < 8);
    CHECK(seen.triangle_count() > 200);
    CHECK(seen.triangle_count() < kCells * kCells / 4);
  }
}

TEST_CASE("colours that nobody tells apart need no triangles") {
  const Paint nearly = [](double x, double y) {
    const double wave = 0.5 + 0.01 * std::sin(70 * x) * std::cos(50 * y);
    return std::array{static_cast<float>(wave), 0.5f, static_cast<float>(wave)};
  };
  const Mesh seen =
      seen_from_above(flat_sheet(AttributeRole::Color, 3, nearly), 0.001, Placement::Optimal);
  CHECK(seen.triangle_count() <= 300);
}

}  // namespace
}  // namespace crease
