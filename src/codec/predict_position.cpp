#include "codec/predict_position.h"

#include "codec/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

Vec3d to_double(const Vec3i& p) {
  return {double(p.x), double(p.y), double(p.z)};
}

// Weights of vectors, and of their parts along the normal beside that: least absolute residuals
// over scans, CAD and city models.
struct Weights {
  double own, other, thirds, sibling;  // middles, and the sibling where it is known
  double normal_own, normal_other, normal_thirds, normal_sibling;  // along the normal
};
constexpr Weights kWeights[] = {
    {0.785, -0.109, -0.253, 0, -0.488, 0.123, 0.045, 0},  // by Leaving
    {0.47, -0.09, -0.05, 0, -0.08, 0.08, -0.17, 0},
    {0.47, -0.09, -0.05, 0, -0.16, 0.30, -0.28, -0.38},
};

// How far off components are: a power of two of logarithms, of the neighbours' misses in the
// tangent plane and along the normal, of edges, and of how far the children's planes part.
struct Scale {
  double tangent_miss, normal_miss, edge, bend;

  double of(const std::array<double, 4>& logarithms) const {
    return tangent_miss * logarithms[0] + normal_miss * logarithms[1] + edge * logarithms[2] +
           bend * logarithms[3];
  }
};
// Of the first two components, and of the others: along the tangent plane, along the normal.
struct Scales {
  Scale mean_tangent, mean_normal, exact_tangent, exact_normal;
  std::array<double, kComponents> tangent, normal;  // what is added to the above
};
constexpr Scales kScales[] = {
    {{0.340, 0.101, 0.453, 0.076},
     {-0.285, 0.561, -0.334, 0.963},
     {0.148, 0.206, 0.460, -0.362},
     {-0.290, 0.419, -0.013, 0.502},
     {-1.366, -0.838, -2.000, -7.777, -6.342, 0.009, -0.358, -0.665},
     {-1.032, 0.866, -1.873, -8.525, -7.578, -0.115, -0.001, -1.059}},
    {{0.329, 0.073, 0.375, 0.112},
     {-0.295, 0.669, -0.275, 0.845},
     {0.145, 0.081, 0.746, -0.208},
     {-0.158, 0.306, 0.192, 0.454},
     {-1.189, -0.681, -3.822, -1.903, -2.256, -2.647, -2.259, -2.468},
     {-1.552, -0.022, -2.562, -1.663, -1.650, -1.567, -1.565, -3.406}},
    {{0.380, 0.073, 0.346, 0.098},
     {-0.335, 0.759, -0.373, 0.913},
     {0.090, 0.119, 0.758, -0.174},
     {-0.202, 0.332, 0.144, 0.582},
     {-1.111, -0.577, -3.939, -2.098, -1.841, -1.997, -2.808, -2.437},
     {-1.480, 0.022, -2.505, -1.659, -1.974, -1.694, -1.505, -3.905}},
};

// By Leaving and number of triangles, from 3 to 8.
constexpr double kPlaceWeights[3][6][kComponents] = {
    {
        {0.417, 0.360, 0.021, 0.071, 0.047, 0.001, 0.001, 0.116},
        {0.551, 0.102, 0.226, 0.021, 0.026, 0.023, 0.012, 0.043},
        {0.760, 0.072, 0.072, 0.016, 0.020, 0.014, 0.020, 0.028},
        {0.686, 0.049, 0.162, 0.016, 0.017, 0.026, 0.026, 0.021},
        {0.704, 0.150, 0.041, 0.014, 0.021, 0.011, 0.010, 0.051},
        {0.520, 0.187, 0.044, 0.034, 0.035, 0.024, 0.025, 0.154},
    },
    {
        {0.354, 0.321, 0.007, 0.001, 0.001, 0.016, 0.016, 0.315},
        {0.546, 0.217, 0.097, 0.001, 0.001, 0.005, 0.007, 0.128},
        {0.743, 0.124, 0.032, 0.001, 0.001, 0.002, 0.002, 0.097},
        {0.816, 0.036, 0.056, 0.001, 0.001, 0.002, 0.002, 0.087},
        {0.673, 0.106, 0.013, 0.001, 0.001, 0.001, 0.001, 0.208},
        {0.457, 0.123, 0.010, 0.001, 0.001, 0.001, 0.001, 0.413},
    },
    {
        {0.212, 0.363, 0.008, 0.002, 0.001, 0.012, 0.008, 0.415},
        {0.490, 0.235, 0.102, 0.001, 0.001, 0.004, 0.003, 0.169},
        {0.718, 0.150, 0.032, 0.001, 0.001, 0.005, 0.002, 0.094},
        {0.821, 0.028, 0.059, 0.001, 0.001, 0.001, 0.002, 0.089},
        {0.715, 0.063, 0.008, 0.001, 0.001, 0.001, 0.002, 0.212},
        {0.493, 0.051, 0.005, 0.001, 0.001, 0.001, 0.001, 0.451},
    },
};

}  // namespace

PlaceWeightsByChild known_place_weights() {
  PlaceWeightsByChild result;
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t k = 0; k < result[i].size(); ++k) {
      std::copy_n(kPlaceWeights[i][k], kComponents, result[i][k].of.begin());
    }
  }
  return result;
}

PlaceMixture place_mixture(const Surroundings& around, Leaving leaving, bool second,
                           const ChildRing& ring, const Miss& miss, const PerComponent& weights) {
  const Weights& w = kWeights[std::size_t(leaving)];
  const Vec3d &own = around.middle[second], &other = around.middle[!second], &n = around.normal;
  const double along = w.normal_own * dot(own, n) + w.normal_other * dot(other, n) +
                       w.normal_thirds * dot(around.thirds, n) +
                       w.normal_sibling * dot(ring.sibling, n);
  const Vec3d mean = own * w.own + other * w.other + around.thirds * w.thirds + n * along;

  PlaceMixture result;
  result.weight = weights;
  const std::array<int, 3>& axis = around.axis;
  if (n[axis[2]] != 0) result.direction = {n[axis[0]], n[axis[1]], n[axis[2]]};
  const auto expect = [&](std::size_t k, const Vec3d& place) {
    result.center[0][k] = place[axis[0]];
    result.center[1][k] = place[axis[1]];
    result.center[2][k] = place[axis[2]] - rise(result.direction, place[axis[0]], place[axis[1]]);
  };
  expect(0, mean);
  expect(1, mean);
  expect(7, {});
  const std::size_t arc = ring.arc.size(), all = arc + 1;
  if (arc > 0) {
    // The ring from the sibling on: halfway between vertices that are opposite, and parallelograms
    // over the triangles at the sibling.
    const auto at = [&](std::size_t i) { return i == 0 ? ring.sibling : ring.arc[i - 1]; };
    expect(2, (at(0) + at(all / 2)) * 0.5);
    expect(3, ring.arc[arc - 1] + ring.sibling - ring.beyond[1]);
    expect(4, ring.arc[0] + ring.sibling - ring.beyond[0]);
    expect(5, (at(1) + at((1 + all / 2) % all)) * 0.5);
    expect(6, (at(all - 1) + at(all - 1 - all / 2)) * 0.5);
  } else {
    for (std::size_t k = 2; k < 7; ++k) result.weight[k] = 0;
  }

  const Scales& s = kScales[std::size_t(leaving)];
  const std::array<double, 4> logarithms{
      rough_log2(miss.tangent + 0.25), rough_log2(miss.normal + 0.25),
      rough_log2(around.mean_edge + 1), rough_log2(around.bend + 1)};
  const std::array<double, 2> tangent{s.mean_tangent.of(logarithms),
                                      s.exact_tangent.of(logarithms)};
  const std::array<double, 2> normal{s.mean_normal.of(logarithms), s.exact_normal.of(logarithms)};
  for (std::size_t k = 0; k < kComponents; ++k) {
    result.tangent[k] = rough_exp2(tangent[k > 1] + s.tangent[k]);
    result.normal[k] = rough_exp2(normal[k > 1] + s.normal[k]);
  }
  return result;
}

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
    if (count > 0) result.middle[second] = sum * (1 / count);
  }
  if (third_count > 0) result.thirds = thirds * (1 / third_count);
  const Vec3d normal = normals[0] + normals[1];
  result.normal = normalized(normal);
  if (size_count > 0) result.mean_edge = size / size_count;
  const double cosine = dot(normalized(normals[0]), normalized(normals[1]));
  result.bend = result.mean_edge * std::sqrt(std::max(0.0, 1 - cosine));

  int main = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[main])) main = k;
  }
  result.axis = {(main + 1) % 3, (main + 2) % 3, main};
  return result;
}

}  // namespace crease::codec
