#include "codec/predict_position.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

Vec3d to_double(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

}  // namespace

Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent) {
  Surroundings result;
  result.parent = parent;
  const Vec3d center = to_double(parent);
  Vec3d thirds{};
  std::array<Vec3d, 2> normals{};  // of each child's triangles, twice their area long
  double third_count = 0, size = 0, size_count = 0;
  for (const bool second : {false, true}) {
    const std::uint32_t own = second ? u : t, other = second ? t : u;
    Vec3d sum{};
    double count = 0;
    for (const std::uint32_t triangle : second ? around_u : around_t) {
      const Corners& corners = mesh.triangles[triangle];
      const std::size_t c = corners[0] == own ? 0 : corners[1] == own ? 1 : 2;
      const std::uint32_t a = corners[(c + 1) % 3], b = corners[(c + 2) % 3];
      const bool shared = a == other || b == other;
      const Vec3d pa = to_double(mesh.positions[a]) - center;
      const Vec3d pb = to_double(mesh.positions[b]) - center;
      if (shared) {
        thirds += a == other ? pb : pa;
        third_count += 1;
      } else {
        normals[second] += cross(pa, pb);
      }
      for (const bool of_b : {false, true}) {
        if ((of_b ? b : a) == other) continue;
        const Vec3d& p = of_b ? pb : pa;
        sum += p;
        count += 1;
        size += std::abs(p.x) + std::abs(p.y) + std::abs(p.z);
        size_count += 1;
      }
    }
    if (count > 0) result.middle[second] = rounded_to_float(sum * (1 / count));
  }
  if (third_count > 0) result.thirds = rounded_to_float(thirds * (1 / third_count));
  const Vec3d normal = normals[0] + normals[1];
  result.normal = rounded_to_float(normalized(normal));
  const double mean_edge = size_count > 0 ? size / size_count : 0;
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
