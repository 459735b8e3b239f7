#include "codec/predict_position.h"

#include "crease/ids.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

Vec3d to_double(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

// From the parent's place.
struct Neighbour {
  std::uint32_t vertex = kNone;
  Vec3d place;
  double size = 0;  // |x| + |y| + |z|
};

}  // namespace

Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent) {
  Surroundings result;
  result.parent = parent;
  const Vec3d center = to_double(parent);
  Vec3d thirds{};
  std::array<Vec3d, 2> normals{};  // of each child's triangles, twice their area long
  double size = 0;
  std::uint32_t third_count = 0, size_count = 0;
  const auto seen = [&](std::uint32_t w) {
    const Vec3d p = to_double(mesh.positions[w]) - center;
    return Neighbour{w, p, std::abs(p.x) + std::abs(p.y) + std::abs(p.z)};
  };
  for (const bool second : {false, true}) {
    const std::uint32_t own = second ? u : t, other = second ? t : u;
    Vec3d sum{}, normal{};
    std::uint32_t count = 0;
    Neighbour a, b;
    for (const std::uint32_t triangle : second ? around_u : around_t) {
      const Corners& corners = mesh.triangles[triangle];
      const std::size_t c = corner_of(corners, own);
      const std::uint32_t after = corners[kCornerAfter[c]], before = corners[kCornerBefore[c]];
      a = b;  // mostly they follow each other
      if (after != b.vertex) a = seen(after);
      b = seen(before);
      if (after == other || before == other) {
        const Neighbour& third = after == other ? b : a;
        thirds += third.place;
        ++third_count;
        sum += third.place;
        size += third.size;
        ++count;
        continue;
      }
      normal += cross(a.place, b.place);
      sum += a.place;
      sum += b.place;
      size += a.size;
      size += b.size;
      count += 2;
    }
    normals[second] = normal;
    size_count += count;
    if (count > 0) result.middle[second] = rounded_to_float(sum * (1 / double(count)));
  }
  if (third_count > 0) result.thirds = rounded_to_float(thirds * (1 / double(third_count)));
  const Vec3d normal = normals[0] + normals[1];
  result.normal = rounded_to_float(normalized(normal));
  const double mean_edge = size_count > 0 ? size / double(size_count) : 0;
  result.mean_edge = static_cast<float>(mean_edge);
  const double cosine = dot(normalized(normals[0]), normalized(normals[1]));
  result.bend = static_cast<float>(mean_edge * std::sqrt(std::max(0.0, 1 - cosine)));

  int main = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[main])) main = k;
  }
  result.axis = {(main + 1) % 3, (main + 2) % 3, main};
  return result;
}

}  // namespace crease::codec
