#include "simplify/scales.h"

#include "hierarchy/triangle_sizes.h"

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
  const double share = kEvenness * std::sqrt(extent.typical_area / extent.mean_area);
  return std::clamp(share, kLeastTypical, 1.0);
}

double area_of(const WorkMesh& work, std::uint32_t t) {
  const std::uint32_t* v = &work.vertex_of_corner[3 * t];
  const auto at = [&](int c) {
    const Vec3i& p = work.positions[v[c]];
    return Vec3d{double(p.x), double(p.y), double(p.z)};
  };
  return 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
}

bool is_texture(const WorkLayer& layer) {
  return layer.source->role == AttributeRole::TexCoord && layer.dimension >= 2;
}

double length_of_texture(const WorkMesh& work, const WorkLayer& layer, double most) {
  TextureSize texture(most);
  for (std::uint32_t t : work.live) {
    const std::uint32_t* value = &layer.of_corner[3 * t];
    texture.add(area_of(work, t), layer.value(value[0]), layer.value(value[1]),
                layer.value(value[2]));
  }
  return std::sqrt(texture.unit2());
}

}  // namespace

Extent measure_extent(const WorkMesh& work) {
  Extent extent;
  TriangleSizes sizes;
  std::uint64_t logarithms = 0;  // bits of floats, which are nearly those of their logarithms
  for (std::uint32_t t : work.live) {
    const double area = area_of(work, t);
    sizes.add(area);
    logarithms += std::bit_cast<std::uint32_t>(static_cast<float>(std::max(area, 1.0)));
  }
  const double count = double(std::max<std::uint64_t>(1, sizes.count()));
  extent.mean_area = std::max(sizes.mean(), 1e-9);
  const auto mean_logarithm = static_cast<std::uint32_t>(double(logarithms) / count);
  extent.typical_area = double(std::bit_cast<float>(mean_logarithm));
  extent.length_of_layer.reserve(work.layers.size());
  for (const WorkLayer& layer : work.layers) {
    extent.length_of_layer.push_back(
        is_texture(layer) ? length_of_texture(work, layer, sizes.most()) : 0);
  }
  return extent;
}

// A texture that slides costs what the slide is long; a normal or a colour costs in proportion to
// the triangles' size, since distance falls with the square of the size, shading with the size.
double set_scales(WorkMesh& work, const Extent& extent, double normal_weight, double left) {
  const double edge = std::sqrt(extent.mean_area * 2.3);  // of an equilateral triangle
  const double color_scale = 0.45 * normal_weight * edge;
  const double normal_scale =
      normal_weight * std::pow(left, kNormalPower) * typical_share(extent) * edge;
  for (std::size_t l = 0; l < work.layers.size(); ++l) {
    WorkLayer& layer = work.layers[l];
    if (layer.source->role == AttributeRole::Other) layer.same = same_number(layer.range);
    if (layer.is_normal) {
      layer.length_per_unit = normal_scale;
    } else if (extent.length_of_layer[l] > 0) {
      const double length_per_unit = extent.length_of_layer[l];
      layer.length_per_unit = 0.3 * length_per_unit;
      layer.same = same_texture(edge / length_per_unit);
    } else {
      layer.length_per_unit = color_scale * layer.importance;
    }
  }
  return normal_scale;
}

}  // namespace crease::simplification
