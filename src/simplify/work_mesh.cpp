#include "simplify/work_mesh.h"

#include "mesh/clean.h"
#include "parallel/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace crease::simplification {

namespace {

// Seams are lines where they are few: that is what tells a chart's border from values by triangle
// or corner, with which a surface full of lines could not be simplified. All of their weight they
// have up to the first share of corners off their vertex's value, and the least from the second on.
// A texture shows what belongs elsewhere where a chart goes beyond its border, so its charts may be
// as small as photogrammetry makes them (0.3 to 0.5), but not of a triangle each (0.8).
struct SeamShares {
  double few, many;
};
constexpr SeamShares kSeams{0.2, 0.35}, kTextureSeams{0.35, 0.6};
constexpr double kLeastSeam = 0.01;

// With so many values a corner each triangle has a chart of its own, and what one contraction
// leaves of them fits no texture: nothing is there that a line could keep.
constexpr double kOwnCharts = 0.93;

double weight_of_seams(const Mesh& mesh, const AttributeLayer& layer) {
  std::vector<std::uint32_t> first(mesh.vertex_count(), kNone);
  std::size_t off = 0;
  for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
    std::uint32_t& at_vertex = first[index_of(mesh.triangles[corner / 3][corner % 3])];
    const auto id = static_cast<std::uint32_t>(layer.of_corner[corner]);
    if (at_vertex == kNone) at_vertex = id;
    off += at_vertex != id;
  }
  if (layer.role == AttributeRole::TexCoord && off > 0 &&
      double(layer.value_count()) > kOwnCharts * double(layer.of_corner.size())) {
    return 0;
  }
  const double share = double(off) / double(std::max<std::size_t>(1, layer.of_corner.size()));
  const SeamShares& seams = layer.role == AttributeRole::TexCoord ? kTextureSeams : kSeams;
  const double many = std::clamp((share - seams.few) / (seams.many - seams.few), 0.0, 1.0);
  return 1 + many * (kLeastSeam - 1);
}

double range_of(const AttributeLayer& layer) {
  double range = 0;
  for (std::size_t k = 0; k < layer.dimension; ++k) {
    double low = 0, high = 0;
    for (std::size_t i = 0; i < layer.value_count(); ++i) {
      const double value = double(layer.values[i * layer.dimension + k]);
      low = i == 0 ? value : std::min(low, value);
      high = i == 0 ? value : std::max(high, value);
    }
    range = std::max(range, high - low);
  }
  return range;
}

// Numbers that are off the mean of those around them by more than this share of their range, on
// average, are noise for the most part, which is not to decide what triangles there are.
constexpr double kNoise = 0.01;

double noise_of(const Mesh& mesh, const AttributeLayer& layer) {
  const std::size_t dimension = layer.dimension;
  std::vector<double> around(mesh.vertex_count() * dimension, 0);
  std::vector<std::uint32_t> count(mesh.vertex_count(), 0), own(mesh.vertex_count(), 0);
  for (std::size_t corner = 0; corner < layer.of_corner.size(); ++corner) {
    const std::size_t first = corner - corner % 3;
    const std::size_t v = index_of(mesh.triangles[first / 3][corner % 3]);
    own[v] = static_cast<std::uint32_t>(layer.of_corner[corner]);
    count[v] += 2;
    for (const std::size_t other : {first + (corner + 1) % 3, first + (corner + 2) % 3}) {
      const std::span<const float> value = layer.value(layer.of_corner[other]);
      for (std::size_t k = 0; k < dimension; ++k) around[v * dimension + k] += double(value[k]);
    }
  }
  double sum = 0;
  std::size_t vertices = 0;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (count[v] == 0) continue;
    double off = 0;
    for (std::size_t k = 0; k < dimension; ++k) {
      const double value = double(layer.values[own[v] * dimension + k]);
      off = std::max(off, std::abs(value - around[v * dimension + k] / count[v]));
    }
    sum += off;
    ++vertices;
  }
  return sum / double(std::max<std::size_t>(1, vertices));
}

// What a unit of it counts for beside one of a colour, whose range is 0 to 1.
double importance_of(const Mesh& mesh, const AttributeLayer& layer, double range) {
  const double noise = noise_of(mesh, layer) / (kNoise * range);
  return 1 / (range * (1 + noise * noise));
}

void add_layers(const Mesh& mesh, WorkMesh& work) {
  for (const AttributeLayer& source : mesh.layers) {
    WorkLayer layer;
    layer.source = &source;
    layer.dimension = static_cast<int>(source.dimension);
    layer.blends = source.interpolation != Interpolation::Categorical;
    layer.is_direction = source.interpolation == Interpolation::Direction;
    layer.is_normal = source.role == AttributeRole::Normal;
    if (!layer.is_normal) layer.line_weight = weight_of_seams(mesh, source);
    layer.range = range_of(source);
    const bool is_other = source.role == AttributeRole::Other;
    layer.steers = layer.blends && (!is_other || layer.range > 0);
    if (is_other && layer.steers) layer.importance = importance_of(mesh, source, layer.range);
    layer.of_corner.reserve(source.of_corner.size());
    for (AttributeId a : source.of_corner) layer.of_corner.push_back(static_cast<std::uint32_t>(a));
    work.layers.push_back(std::move(layer));
  }
}

void find_categories(const Mesh& mesh, WorkMesh& work) {
  if (mesh.material_of_triangle.empty() && mesh.part_of_triangle.empty()) return;
  work.material_count =
      std::max<std::uint32_t>(1, static_cast<std::uint32_t>(mesh.materials.size()));
  work.category_of_triangle.assign(mesh.triangle_count(), 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    std::uint32_t& category = work.category_of_triangle[t];
    if (!mesh.part_of_triangle.empty()) {
      category = static_cast<std::uint32_t>(mesh.part_of_triangle[t]) * work.material_count;
    }
    if (!mesh.material_of_triangle.empty()) {
      category += static_cast<std::uint32_t>(mesh.material_of_triangle[t]);
    }
  }
}

// Along the normal that the winding tells.
Vec3d twice_area_of(const WorkMesh& work, std::size_t t) {
  const std::uint32_t* v = &work.vertex_of_corner[3 * t];
  const auto at = [&](int c) {
    const Vec3i& p = work.positions[v[c]];
    return Vec3d{double(p.x), double(p.y), double(p.z)};
  };
  return cross(at(1) - at(0), at(2) - at(0));
}

// Flat triangles remember the input normals that they stand for.
void find_represented(const Mesh& mesh, WorkMesh& work) {
  const AttributeLayer* normals = mesh.normals();
  const auto is_flat = [&](std::size_t t) {
    const AttributeId* id = &normals->of_corner[3 * t];
    return id[0] == id[1] && id[1] == id[2];
  };
  bool any_flat = false;
  for (std::size_t t = 0; normals && t < mesh.triangle_count() && !any_flat; ++t) {
    any_flat = is_flat(t);
  }
  if (!any_flat) return;
  work.represented.resize(mesh.triangle_count());
  std::atomic<bool> any_against = false;
  const auto find_of = [&](std::size_t t) {
    const Vec3d twice = twice_area_of(work, t);
    const double area = 0.5 * length(twice);
    const std::span<const float> n = normals->value(normals->of_corner[3 * t]);
    const Vec3d sum = Vec3d{double(n[0]), double(n[1]), double(n[2])} * area;
    if (dot(twice, sum) < 0) any_against = true;
    work.represented[t] = {
        {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)},
        static_cast<float>(area)};
  };
  parallel_ranges(mesh.triangle_count(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t != end; ++t) find_of(t);
  });
  if (any_against) work.inside_out.resize(mesh.triangle_count());
}

}  // namespace

WorkMesh make_work(const Mesh& mesh, const Grid& grid) {
  WorkMesh work;
  parallel_both(
      [&] {
        work.positions.reserve(mesh.vertex_count());
        for (const Vec3d& p : mesh.positions) work.positions.push_back(grid.nearest(p));
        work.error_of_vertex.resize(mesh.vertex_count());
        work.grown_of_vertex.resize(mesh.vertex_count());
        work.vertex_of_corner.reserve(3 * mesh.triangle_count());
        for (const Triangle& triangle : mesh.triangles) {
          for (VertexId v : triangle) {
            work.vertex_of_corner.push_back(static_cast<std::uint32_t>(v));
          }
        }
      },
      [&] {
        work.live.resize(mesh.triangle_count());
        std::iota(work.live.begin(), work.live.end(), 0u);
        work.derived.assign(mesh.triangle_count(), 0);
        add_layers(mesh, work);
        find_categories(mesh, work);
      });
  find_represented(mesh, work);
  return work;
}

// Of a part's area, times cosines: what is wrong with single triangles is no reason to turn others.
constexpr double kMostlyAgainst = 0.9;

void find_inside_out(WorkMesh& work) {
  if (work.inside_out.empty()) return;
  const auto agreement = [&](std::size_t t) {  // the area, times the cosine
    const Vec3d twice = twice_area_of(work, t);
    const double size = length(twice);
    return size > 0 ? dot(twice * (1 / size), to_double(work.represented[t].sum)) : 0;
  };
  const auto part_of = [&](std::size_t t) {
    return work.part_of_vertex[work.vertex_of_corner[3 * t]];
  };
  struct Part {
    double agreement = 0, area = 0;
  };
  std::vector<Part> parts(work.positions.size());  // by their vertex
  for (std::size_t t = 0; t < work.inside_out.size(); ++t) {
    Part& part = parts[part_of(t)];
    part.agreement += agreement(t);
    part.area += double(work.represented[t].area);
  }
  for (std::size_t t = 0; t < work.inside_out.size(); ++t) {
    const Part& part = parts[part_of(t)];
    work.inside_out[t] = agreement(t) < 0 && part.agreement < -kMostlyAgainst * part.area;
  }
}

// Of so many triangles one. Coarse levels always have some: a house that became flat.
constexpr std::size_t kManyCopies = 100;

void find_copies(const Mesh& mesh, WorkMesh& work) {
  work.has_copies = kManyCopies * count_duplicate_triangles(mesh) > mesh.triangle_count();
}

}  // namespace crease::simplification
