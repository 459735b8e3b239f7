#include "view/pick.h"

#include "runtime/block_mesh_impl.h"
#include "runtime/resident_block.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

struct Crossing {
  double along, u, v;
};

// Moeller and Trumbore's test, of both sides.
std::optional<Crossing> cross_triangle(const Ray& ray, const std::array<Vec3d, 3>& p) {
  const Vec3d first = p[1] - p[0], second = p[2] - p[0];
  const Vec3d across = cross(ray.direction, second);
  const double volume = dot(first, across);
  if (volume == 0) return std::nullopt;
  const Vec3d from = ray.origin - p[0];
  const double u = dot(from, across) / volume;
  if (u < 0 || u > 1) return std::nullopt;
  const Vec3d around = cross(from, first);
  const double v = dot(ray.direction, around) / volume;
  if (v < 0 || u + v > 1) return std::nullopt;
  const double along = dot(second, around) / volume;
  if (!(along > 0)) return std::nullopt;
  return Crossing{along, u, v};
}

struct Nearest {
  Crossing crossing{HUGE_VAL, 0, 0};
  TriangleKind kind{};
  std::uint32_t triangle = 0;
  bool is_found = false;
};

void find_in(const DrawList& list, const DrawPart& part, TriangleKind kind, const Range& range,
             const Ray& ray, Nearest& nearest) {
  for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
    std::array<Vec3d, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = to_double(list.positions[part.indices[3 * std::size_t(t) + c]]);
    }
    const std::optional<Crossing> crossing = cross_triangle(ray, p);
    if (!crossing || crossing->along >= nearest.crossing.along) continue;
    nearest = {*crossing, kind, t, true};
  }
}

Vec3f normal_at(const DrawList& list, const DrawPart& part, const Nearest& at) {
  const std::size_t first = 3 * std::size_t(at.triangle);
  if (at.kind == TriangleKind::FN) return part.normals[at.triangle];
  const auto corner = [&](std::size_t c) {
    return at.kind == TriangleKind::NSN ? part.normals[first + c]
                                        : list.vertex_normals[part.indices[first + c]];
  };
  const float u = float(at.crossing.u), v = float(at.crossing.v);
  return normalized(corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v);
}

Hit describe(const DrawList& list, const Nearest& at, const Ray& ray) {
  const DrawPart& part = part_of_kind(list, at.kind);
  Hit hit;
  hit.along = at.crossing.along;
  hit.position = ray.origin + ray.direction * hit.along;
  hit.kind = at.kind;
  hit.triangle = at.triangle;
  for (std::size_t c = 0; c < 3; ++c) {
    hit.corners[c] =
        list.origin + to_double(list.positions[part.indices[3 * std::size_t(at.triangle) + c]]);
  }
  hit.normal = normal_at(list, part, at);
  if (!part.materials.empty() && part.materials[at.triangle] < list.materials.size()) {
    hit.material = list.materials[part.materials[at.triangle]].name;
  }
  return hit;
}

bool passes_sphere(const Ray& ray, const Vec3d& center, double radius) {
  const Vec3d direction = normalized(ray.direction);
  const Vec3d to = center - ray.origin;
  const double ahead = dot(to, direction);
  if (ahead < -radius) return true;
  return length(to - direction * ahead) > radius;
}

}  // namespace

const DrawPart& part_of_kind(const DrawList& list, TriangleKind kind) {
  return kind == TriangleKind::SN ? list.sn : kind == TriangleKind::FN ? list.fn : list.nsn;
}

std::optional<Hit> pick(const DrawList& list, const DrawRanges& ranges, const Ray& ray) {
  const Ray near{ray.origin - list.origin, ray.direction};
  Nearest nearest;
  find_in(list, list.sn, TriangleKind::SN, ranges.sn, near, nearest);
  find_in(list, list.fn, TriangleKind::FN, ranges.fn, near, nearest);
  find_in(list, list.nsn, TriangleKind::NSN, ranges.nsn, near, nearest);
  if (!nearest.is_found) return std::nullopt;
  return describe(list, nearest, ray);
}

std::optional<Hit> pick(const DrawList& list, const Ray& ray) {
  return pick(list, all_of(list), ray);
}

std::optional<Hit> pick(std::span<const ShownRange> shown, const Grid& grid, const Ray& ray) {
  std::optional<Hit> nearest;
  for (const ShownRange& range : shown) {
    const BlockFacts& facts = range.block->facts();
    // A grid unit more, for what rounding takes.
    if (passes_sphere(ray, grid.position(facts.center), (facts.radius + 1.0) * grid.step)) continue;
    std::optional<Hit> hit = pick(range.block->draw_list(), {range.sn, range.fn, range.nsn}, ray);
    if (!hit || (nearest && hit->along >= nearest->along)) continue;
    nearest = std::move(hit);
    nearest->block = range.block;
  }
  return nearest;
}

std::optional<Hit> pick(std::span<const ShownCut> shown, const Grid& grid, const Ray& ray) {
  std::optional<Hit> nearest;
  for (const ShownCut& cut : shown) {
    const BlockFacts& facts = cut.block->facts();
    if (passes_sphere(ray, grid.position(facts.center), (facts.radius + 1.0) * grid.step)) continue;
    std::optional<Hit> hit = pick(cut.list, ray);
    if (!hit || (nearest && hit->along >= nearest->along)) continue;
    nearest = std::move(hit);
    nearest->block = cut.block;
    nearest->is_by_vertex = true;
  }
  return nearest;
}

std::string part_of(const Hit& hit, const BlockMesh& mesh) {
  if (hit.block == nullptr) return {};
  if (!hit.is_by_vertex) {
    return name_of(hit.block->part_of(hit.kind, hit.triangle), mesh.part_names());
  }
  ShownCut cut;
  cut.block = hit.block;
  return name_of(mesh.part_of(cut, hit.kind, hit.triangle), mesh.part_names());
}

std::string name_of(PartId part, std::span<const std::string> names) {
  return index_of(part) < names.size() ? names[index_of(part)] : std::string();
}

}  // namespace crease
