#include "simplify/scales.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace crease::simplification {

namespace {

// What normals weigh falls with this power of the share of the triangles that is left: where
// triangles become as large as what is shown the surface goes wrong before its shading does.
constexpr double kNormalPower = 0.2;

// Where few triangles have most of the area, walls around what was modelled with care, the mean is
// no measure of the others: normals would decide all of it there. So what a normal costs is in
// proportion to the typical triangle's edge, as kEvenness has it for a surface of even triangles,
// but to no less than kLeastTypical of the mean one's.
constexpr double kEvenness = 1.2, kLeastTypical = 0.5;

double typical_share(const Extent& extent) {
  const double share = kEvenness * std::sqrt(extent.typical_area / extent.triangle_area());
  return std::clamp(share, kLeastTypical, 1.0);
}

}  // namespace

Extent measure_extent(const WorkMesh& work) {
  Extent extent;
  extent.triangles = work.live.size();
  extent.area_of_layer.assign(work.layers.size(), 0);
  std::uint64_t logarithms = 0;  // bits of floats, which are nearly those of their logarithms
  for (std::uint32_t t : work.live) {
    const std::uint32_t* v = &work.vertex_of_corner[3 * t];
    const auto at = [&](int c) {
      const Vec3i& p = work.positions[v[c]];
      return Vec3d{double(p.x), double(p.y), double(p.z)};
    };
    const double area = 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
    extent.area += area;
    logarithms += std::bit_cast<std::uint32_t>(static_cast<float>(std::max(area, 1.0)));
    for (std::size_t l = 0; l < work.layers.size(); ++l) {
      const WorkLayer& layer = work.layers[l];
      if (layer.source->role != AttributeRole::TexCoord || layer.dimension < 2) continue;
      const float* a = layer.value(layer.of_corner[3 * t]);
      const float* b = layer.value(layer.of_corner[3 * t + 1]);
      const float* c = layer.value(layer.of_corner[3 * t + 2]);
      extent.area_of_layer[l] += 0.5 * std::abs(double(b[0] - a[0]) * double(c[1] - a[1]) -
                                                double(c[0] - a[0]) * double(b[1] - a[1]));
    }
  }
  const std::uint64_t count = std::max<std::uint64_t>(1, extent.triangles);
  extent.typical_area =
      double(std::bit_cast<float>(static_cast<std::uint32_t>(logarithms / count)));
  return extent;
}

// A texture that slides costs what the slide is long; a normal or a colour costs in proportion to
// the triangles' size, since distance falls with the square of the size, shading with the size.
double set_scales(WorkMesh& work, const Extent& extent, double normal_weight, double left) {
  const double edge = std::sqrt(extent.triangle_area() * 2.3);  // of an equilateral triangle
  const double color_scale = 0.45 * normal_weight * edge;
  const double normal_scale =
      normal_weight * std::pow(left, kNormalPower) * typical_share(extent) * edge;
  for (std::size_t l = 0; l < work.layers.size(); ++l) {
    WorkLayer& layer = work.layers[l];
    if (layer.source->role == AttributeRole::Other) layer.same = same_number(layer.range);
    if (layer.is_normal) {
      layer.length_per_unit = normal_scale;
    } else if (extent.area_of_layer[l] > 0) {
      const double length_per_unit = std::sqrt(extent.area / extent.area_of_layer[l]);
      layer.length_per_unit = 0.3 * length_per_unit;
      layer.same = same_texture(edge / length_per_unit);
    } else {
      layer.length_per_unit = color_scale * layer.importance;
    }
  }
  return normal_scale;
}

}  // namespace crease::simplification
