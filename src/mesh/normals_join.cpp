// Step 1 of join_normals() works on clusters at a vertex, step 2 on patches of clusters:
//
//      normals at a vertex         clusters              a patch: clusters joined by triangles
//        \ | /                       \|                      *-----*
//   ------ v ------   -->       ---- v ----    -->           | \   |   all corners within the angle:
//                                                            *-----*   one normal
#include "mesh/clean.h"
#include "mesh/disjoint_sets.h"
#include "mesh/normals.h"
#include "mesh/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace crease {

namespace {

// A vertex where thousands of normals meet compares each with the latest clusters only.
constexpr std::size_t kMaxComparedClusters = 64;
constexpr std::size_t kMaxComparedMembers = 64;

Vec3d normal_at(const AttributeLayer& normals, AttributeId a) {
  const std::span<const float> v = normals.value(a);
  return {v[0], v[1], v[2]};
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// The largest angle between any two of the normals, or infinity if it is beyond about 60 degrees.
// Measured as the extent in 32 directions of the plane across the mean: 0.12 % short at most.
double spread_of(const AttributeLayer& normals, std::span<const std::uint32_t> corners,
                 const Vec3d& mean) {
  constexpr int kDirections = 32;
  if (mean == Vec3d{}) return INFINITY;
  const Vec3d across = std::abs(mean.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = normalized(cross(mean, across)), v = cross(mean, u);
  std::array<double, kDirections> cosine, sine, low, high;
  for (int d = 0; d < kDirections; ++d) {
    cosine[d] = std::cos(kPi * d / kDirections);
    sine[d] = std::sin(kPi * d / kDirections);
  }
  low.fill(INFINITY);
  high.fill(-INFINITY);
  AttributeId previous = kNoAttribute;
  for (std::uint32_t corner : corners) {
    const AttributeId a = normals.of_corner[corner];
    if (a == previous) continue;
    previous = a;
    const Vec3d n = normal_at(normals, a);
    if (dot(n, mean) < 0.5) return INFINITY;
    const double x = dot(n, u), y = dot(n, v);
    for (int d = 0; d < kDirections; ++d) {
      const double along = x * cosine[d] + y * sine[d];
      low[d] = std::min(low[d], along);
      high[d] = std::max(high[d], along);
    }
  }
  double widest = 0;
  for (int d = 0; d < kDirections; ++d) widest = std::max(widest, high[d] - low[d]);
  return 2 * std::asin(std::min(1.0, widest / 2));
}

// Rows sorted by key, rows with equal keys in their old order.
struct Buckets {
  std::vector<std::uint32_t> begin, rows;
  std::span<std::uint32_t> of(std::size_t key) {
    return std::span<std::uint32_t>(rows).subspan(begin[key], begin[key + 1] - begin[key]);
  }
};

template <typename Key>
Buckets sort_into_buckets(std::uint32_t row_count, std::size_t key_count, Key key) {
  Buckets buckets;
  buckets.begin.assign(key_count + 1, 0);
  for (std::uint32_t i = 0; i < row_count; ++i) ++buckets.begin[key(i) + 1];
  std::partial_sum(buckets.begin.begin(), buckets.begin.end(), buckets.begin.begin());
  std::vector<std::uint32_t> next(buckets.begin.begin(), buckets.begin.end() - 1);
  buckets.rows.resize(row_count);
  for (std::uint32_t i = 0; i < row_count; ++i) buckets.rows[next[key(i)]++] = i;
  return buckets;
}

struct Clusters {
  std::vector<std::uint32_t> of_corner;
  std::vector<Vec3d> sums;      // of the normals of its corners
  std::vector<AttributeId> of;  // the one value of all its corners, or kNoAttribute
};

// Step 1. `corners` are those of one vertex, sorted by normal.
void cluster_vertex(const AttributeLayer& normals, std::span<const std::uint32_t> corners,
                    double angle, Clusters& clusters) {
  struct Open {
    std::uint32_t id;
    std::vector<Vec3d> members;
  };
  std::vector<Open> open;
  const auto fits = [&](const Open& cluster, const Vec3d& n) {
    return cluster.members.size() < kMaxComparedMembers &&
           std::all_of(cluster.members.begin(), cluster.members.end(),
                       [&](const Vec3d& m) { return angle_between(m, n) <= angle; });
  };
  for (std::size_t i = 0; i < corners.size();) {
    const AttributeId a = normals.of_corner[corners[i]];
    const Vec3d n = normal_at(normals, a);
    const std::size_t from = open.size() - std::min(open.size(), kMaxComparedClusters);
    auto home = std::find_if(open.begin() + from, open.end(),
                             [&](const Open& cluster) { return fits(cluster, n); });
    if (home == open.end()) {
      open.push_back({static_cast<std::uint32_t>(clusters.sums.size()), {}});
      home = open.end() - 1;
      clusters.sums.push_back({});
      clusters.of.push_back(a);
    }
    home->members.push_back(n);
    if (clusters.of[home->id] != a) clusters.of[home->id] = kNoAttribute;
    for (; i < corners.size() && normals.of_corner[corners[i]] == a; ++i) {
      clusters.of_corner[corners[i]] = home->id;
      clusters.sums[home->id] += n;
    }
  }
}

Clusters cluster_at_vertices(const AttributeLayer& normals, const Mesh& mesh, double angle) {
  const std::uint32_t corner_count = static_cast<std::uint32_t>(normals.of_corner.size());
  Buckets at_vertex = sort_into_buckets(corner_count, mesh.vertex_count(), [&](std::uint32_t corner) {
    return index_of(mesh.triangles[corner / 3][corner % 3]);
  });
  Clusters clusters;
  clusters.of_corner.resize(corner_count);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::span<std::uint32_t> corners = at_vertex.of(v);
    std::sort(corners.begin(), corners.end(), [&](std::uint32_t a, std::uint32_t b) {
      return normals.of_corner[a] != normals.of_corner[b]
                 ? normals.of_corner[a] < normals.of_corner[b]
                 : a < b;
    });
    cluster_vertex(normals, corners, angle, clusters);
  }
  return clusters;
}

}  // namespace

std::size_t join_normals(AttributeLayer& normals, const Mesh& mesh, double angle_deg) {
  weld_layer(normals);
  const double angle = radians(angle_deg) * (1 + 1e-6);
  const std::uint32_t corner_count = static_cast<std::uint32_t>(normals.of_corner.size());
  Clusters clusters = cluster_at_vertices(normals, mesh, angle);

  DisjointSets connected(clusters.sums.size());
  for (std::uint32_t corner = 0; corner < corner_count; corner += 3) {
    connected.unite(clusters.of_corner[corner], clusters.of_corner[corner + 1]);
    connected.unite(clusters.of_corner[corner], clusters.of_corner[corner + 2]);
  }

  // Step 2: a patch is its representative cluster's number; most numbers have no corners.
  Buckets in_patch = sort_into_buckets(corner_count, clusters.sums.size(), [&](std::uint32_t corner) {
    return connected.find(clusters.of_corner[corner]);
  });
  std::vector<AttributeId> new_of_corner(corner_count, kNoAttribute);
  std::vector<AttributeId> new_of_cluster = clusters.of;
  const auto add_value = [&](const Vec3d& sum, AttributeId fallback) {
    const Vec3d n = normalized(sum);
    if (n == Vec3d{}) return fallback;
    const auto id = static_cast<std::uint32_t>(normals.value_count());
    for (int i = 0; i < 3; ++i) normals.values.push_back(static_cast<float>(n[i]));
    return AttributeId{id};
  };
  for (std::size_t patch = 0; patch < clusters.sums.size(); ++patch) {
    const std::span<const std::uint32_t> corners = in_patch.of(patch);
    if (corners.empty()) continue;
    const AttributeId first = normals.of_corner[corners[0]];
    Vec3d sum;
    bool all_equal = true;
    for (std::uint32_t corner : corners) {
      sum += normal_at(normals, normals.of_corner[corner]);
      all_equal = all_equal && normals.of_corner[corner] == first;
    }
    if (all_equal) {
      for (std::uint32_t corner : corners) new_of_corner[corner] = first;
      continue;
    }
    const bool is_flat = spread_of(normals, corners, normalized(sum)) <= angle;
    const AttributeId one = is_flat ? add_value(sum, first) : kNoAttribute;
    for (std::uint32_t corner : corners) {
      const std::uint32_t c = clusters.of_corner[corner];
      if (!is_flat && new_of_cluster[c] == kNoAttribute) {
        new_of_cluster[c] = add_value(clusters.sums[c], normals.of_corner[corner]);
      }
      new_of_corner[corner] = is_flat ? one : new_of_cluster[c];
    }
  }

  // A (vertex, normal) pair is counted at the first of its corners; corners of a pair that are not
  // neighbours in the vertex's list do not occur, as clusters took them sorted by normal.
  std::size_t changed = 0;
  Buckets in_cluster = sort_into_buckets(corner_count, clusters.sums.size(),
                                         [&](std::uint32_t corner) { return clusters.of_corner[corner]; });
  for (std::size_t c = 0; c < clusters.sums.size(); ++c) {
    const std::span<std::uint32_t> corners = in_cluster.of(c);
    std::sort(corners.begin(), corners.end(), [&](std::uint32_t a, std::uint32_t b) {
      return normals.of_corner[a] < normals.of_corner[b];
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const AttributeId old = normals.of_corner[corners[i]];
      if (i > 0 && normals.of_corner[corners[i - 1]] == old) continue;
      const std::span<const float> before = normals.value(old);
      const std::span<const float> after = normals.value(new_of_corner[corners[i]]);
      changed += !std::equal(before.begin(), before.end(), after.begin());
    }
  }
  normals.of_corner = std::move(new_of_corner);
  weld_layer(normals);
  return changed;
}

}  // namespace crease
