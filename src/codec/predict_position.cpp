#include "codec/predict_position.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crease::codec {

namespace {

constexpr double kLimit = 1 << 30;  // grid coordinates lie within

std::int32_t rounded(double x) {
  return static_cast<std::int32_t>(std::floor(std::clamp(x, -kLimit, kLimit) + 0.5));
}

Vec3d to_double(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

// Weights of vectors, and of their parts along the normal beside that: least absolute residuals
// over scans, CAD and city models (bunny, nefertiti, lucy, fandisk, kuka).
struct Weights {
  double own, other, thirds;                       // middles
  double normal_own, normal_other, normal_thirds;  // along the normal
};
constexpr Weights kBesideParent{0.75, -0.09, -0.19, -0.24, -0.02, 0.05};
constexpr Weights kSecondOfBoth{0.47, -0.09, -0.05, -0.08, 0.08, -0.17};
constexpr Weights kFirstOfBoth{0.47, -0.09, -0.05, -0.16, 0.30, -0.28};
constexpr double kFirstAgainstSecond = -0.38;  // along the normal

Vec3i moved(const Vec3i& parent, const Vec3d& step) {
  return {rounded(parent.x + step.x), rounded(parent.y + step.y), rounded(parent.z + step.z)};
}

Vec3d weighed(const Surroundings& s, const Weights& w, bool second) {
  const Vec3d &own = s.middle[second], &other = s.middle[!second];
  const double along = w.normal_own * dot(own, s.normal) + w.normal_other * dot(other, s.normal) +
                       w.normal_thirds * dot(s.thirds, s.normal);
  return own * w.own + other * w.other + s.thirds * w.thirds + s.normal * along;
}

}  // namespace

std::size_t half_octave(float x) {
  const std::uint32_t whole = static_cast<std::uint32_t>(std::clamp(4 * x, 0.0f, 4e9f));
  const int length = std::min(static_cast<int>(std::bit_width(whole)), 15);
  return std::size_t(2 * length) + (length > 1 ? whole >> (length - 2) & 1 : 0);
}

double magnitude_of(std::size_t half_octave) {
  const double whole = double(std::uint64_t(1) << half_octave / 2) * 0.5;
  return 0.25 * whole * (half_octave % 2 ? 1.75 : 1.25);
}

Vec3i Surroundings::beside_parent(bool second) const {
  return moved(parent, weighed(*this, kBesideParent, second));
}

Vec3i Surroundings::second_of_both() const {
  return moved(parent, weighed(*this, kSecondOfBoth, true));
}

Vec3i Surroundings::first_of_both(const Vec3i& second) const {
  const double along = kFirstAgainstSecond * dot(to_double(second) - to_double(parent), normal);
  return moved(parent, weighed(*this, kFirstOfBoth, false) + normal * along);
}

std::int32_t Surroundings::shear(std::int32_t first, std::int32_t second) const {
  return rounded(slope[0] * first + slope[1] * second);
}

Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent) {
  Surroundings result;
  result.parent = parent;
  const Vec3d center = to_double(parent);
  Vec3d thirds{}, normal{};
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
        normal += cross(pa, pb);
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
    if (count > 0) result.middle[second] = sum * (1 / count);
  }
  if (third_count > 0) result.thirds = thirds * (1 / third_count);
  result.normal = normalized(normal);
  if (size_count > 0) result.mean_edge = size / size_count;

  int main = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[main])) main = k;
  }
  result.axis = {(main + 1) % 3, (main + 2) % 3, main};
  if (normal[main] != 0) {
    result.slope = {-normal[(main + 1) % 3] / normal[main], -normal[(main + 2) % 3] / normal[main]};
  }
  return result;
}

}  // namespace crease::codec
