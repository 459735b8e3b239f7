// join_normals() in three steps:
//
//      normals at a vertex         clusters              a patch: clusters connected by triangles
//        \ | /                       \|                      *-----*
//   ------ v ------   -->       ---- v ----    -->           | \   |   all corners within the
//   angle:
//                                                            *-----*   one normal
//
// and in a patch that is not flat, values that meet at its vertices are gathered around the most
// used ones. Gathering values, not corners, keeps together what shared a normal before.
#include "mesh/clean.h"
#include "mesh/disjoint_sets.h"
#include "mesh/normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace crease {

namespace {

// A vertex where thousands of normals meet compares each with the latest clusters only.
constexpr std::size_t kMaxComparedClusters = 64;
constexpr std::size_t kMaxComparedMembers = 64;

Vec3d normal_at(const AttributeLayer& normals, AttributeId a) {
  const std::span<const float> v = normals.value(a);
  return {v[0], v[1], v[2]};
}

std::size_t vertex_at(const Mesh& mesh, std::size_t corner) {
  return index_of(mesh.triangles[corner / 3][corner % 3]);
}

// Per vertex: its corners have several normals.
std::vector<bool> mixed_vertices(const AttributeLayer& normals, const Mesh& mesh) {
  std::vector<AttributeId> first(mesh.vertex_count(), kNoAttribute);
  std::vector<bool> is_mixed(mesh.vertex_count(), false);
  for (std::size_t corner = 0; corner < normals.of_corner.size(); ++corner) {
    AttributeId& own = first[vertex_at(mesh, corner)];
    if (own == kNoAttribute) own = normals.of_corner[corner];
    if (own != normals.of_corner[corner]) is_mixed[vertex_at(mesh, corner)] = true;
  }
  return is_mixed;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b));
}

// How far a set of normals reaches around `axis`: its extent in 16 directions of the plane across,
// which is 0.5 % short of the largest distance at most.
class Spread {
 public:
  explicit Spread(const Vec3d& axis) : axis_(axis) {
    const Vec3d across = std::abs(axis.x) < 0.5 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    u_ = normalized(cross(axis, across));
    v_ = cross(axis, u_);
    low_.fill(INFINITY);
    high_.fill(-INFINITY);
  }
  // The angle that the set spans with `n` added; infinity if `n` is beyond 60 degrees of the axis.
  double with(const Vec3d& n) const {
    Spread more = *this;
    more.add(n);
    return more.angle();
  }
  void add(const Vec3d& n) {
    // As on a map around the axis whose distances from it are angles. No two normals are nearer on
    // it than they are; plain shadows would be shorter the further from the axis they lie.
    const double along_axis = dot(n, axis_), across = length(cross(axis_, n));
    is_beyond_ = is_beyond_ || along_axis < 0.5;
    const double stretch = across > 0 ? std::atan2(across, along_axis) / across : 1;
    const double x = dot(n, u_) * stretch, y = dot(n, v_) * stretch;
    for (int d = 0; d < kDirections; ++d) {
      const double along = x * kCosines[d] + y * kSines[d];
      low_[d] = std::min(low_[d], along);
      high_[d] = std::max(high_[d], along);
    }
  }
  double angle() const {
    if (is_beyond_) return INFINITY;
    double widest = 0;
    for (int d = 0; d < kDirections; ++d) widest = std::max(widest, high_[d] - low_[d]);
    return widest;
  }

 private:
  static constexpr int kDirections = 16;
  // cos and sin of d * 180 / 16 degrees.
  static constexpr std::array<double, kDirections> kCosines{1.0,
                                                            0.98078528040323043,
                                                            0.92387953251128674,
                                                            0.83146961230254524,
                                                            0.70710678118654757,
                                                            0.55557023301960218,
                                                            0.38268343236508984,
                                                            0.19509032201612825,
                                                            0.0,
                                                            -0.19509032201612825,
                                                            -0.38268343236508984,
                                                            -0.55557023301960218,
                                                            -0.70710678118654757,
                                                            -0.83146961230254524,
                                                            -0.92387953251128674,
                                                            -0.98078528040323043};
  static constexpr std::array<double, kDirections> kSines{0.0,
                                                          0.19509032201612825,
                                                          0.38268343236508984,
                                                          0.55557023301960218,
                                                          0.70710678118654757,
                                                          0.83146961230254524,
                                                          0.92387953251128674,
                                                          0.98078528040323043,
                                                          1.0,
                                                          0.98078528040323043,
                                                          0.92387953251128674,
                                                          0.83146961230254524,
                                                          0.70710678118654757,
                                                          0.55557023301960218,
                                                          0.38268343236508984,
                                                          0.19509032201612825};
  Vec3d axis_, u_, v_;
  std::array<double, kDirections> low_, high_;
  bool is_beyond_ = false;
};

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
  std::uint32_t count = 0;
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
      open.push_back({clusters.count++, {}});
      home = open.end() - 1;
    }
    home->members.push_back(n);
    for (; i < corners.size() && normals.of_corner[corners[i]] == a; ++i) {
      clusters.of_corner[corners[i]] = home->id;
    }
  }
}

Clusters cluster_at_vertices(const AttributeLayer& normals, const Mesh& mesh, double angle) {
  const std::uint32_t corner_count = static_cast<std::uint32_t>(normals.of_corner.size());
  Buckets at_vertex =
      sort_into_buckets(corner_count, mesh.vertex_count(),
                        [&](std::uint32_t corner) { return vertex_at(mesh, corner); });
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

// Step 2: one value for the whole patch if it spans no more than `angle`.
bool is_flat(const AttributeLayer& normals, std::span<const std::uint32_t> corners,
             const Vec3d& sum, double angle) {
  if (normalized(sum) == Vec3d{}) return false;
  Spread spread(normalized(sum));
  AttributeId previous = kNoAttribute;
  for (std::uint32_t corner : corners) {
    const AttributeId a = normals.of_corner[corner];
    if (a != previous) spread.add(normal_at(normals, a));
    previous = a;
  }
  return spread.angle() <= angle;
}

// Step 3, for the corners of one patch. Values are numbered within the patch.
class ValueGathering {
 public:
  // Only vertices with several values can join any; on a smooth surface there are few.
  ValueGathering(const AttributeLayer& normals, const Mesh& mesh, const std::vector<bool>& is_mixed,
                 std::span<const std::uint32_t> corners, double angle)
      : angle_(angle) {
    std::vector<std::pair<std::size_t, AttributeId>> at_vertex;
    for (std::uint32_t corner : corners) {
      const std::size_t v = vertex_at(mesh, corner);
      if (!is_mixed[v]) continue;
      at_vertex.emplace_back(v, normals.of_corner[corner]);
      ids_.push_back(normals.of_corner[corner]);
    }
    std::sort(ids_.begin(), ids_.end());
    for (std::size_t begin = 0, end = 0, kept = 0; begin < ids_.size(); begin = end) {
      while (end < ids_.size() && ids_[end] == ids_[begin]) ++end;
      corner_counts_.push_back(static_cast<std::uint32_t>(end - begin));
      values_.push_back(normal_at(normals, ids_[begin]));
      ids_[kept++] = ids_[begin];
    }
    ids_.resize(values_.size());
    std::sort(at_vertex.begin(), at_vertex.end());
    at_vertex.erase(std::unique(at_vertex.begin(), at_vertex.end()), at_vertex.end());
    link_values(at_vertex);
  }
  bool joins_any() const { return !links_.empty(); }

  // Finds which values become one.
  void gather() {
    cluster_of_.assign(ids_.size(), kNone);
    std::vector<std::uint32_t> seeds(ids_.size());
    std::iota(seeds.begin(), seeds.end(), 0u);
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::uint32_t a, std::uint32_t b) {
      return corner_counts_[a] > corner_counts_[b];
    });
    for (std::uint32_t seed : seeds) {
      if (cluster_of_[seed] == kNone) grow(seed);
    }
  }
  // The seed of the value's cluster, or kNone where it stands alone.
  std::uint32_t cluster_of(AttributeId a) const {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), a);
    return found == ids_.end() || *found != a ? kNone : cluster_of_[found - ids_.begin()];
  }
  std::size_t value_count() const { return ids_.size(); }

 private:
  std::uint32_t number_of(AttributeId a) const {
    return static_cast<std::uint32_t>(std::lower_bound(ids_.begin(), ids_.end(), a) - ids_.begin());
  }
  void link_values(const std::vector<std::pair<std::size_t, AttributeId>>& at_vertex) {
    for (std::size_t begin = 0, end = 0; begin < at_vertex.size(); begin = end) {
      while (end < at_vertex.size() && at_vertex[end].first == at_vertex[begin].first) ++end;
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t j = i + 1; j < std::min(end, i + kMaxComparedMembers); ++j) {
          const std::uint32_t a = number_of(at_vertex[i].second),
                              b = number_of(at_vertex[j].second);
          if (angle_between(values_[a], values_[b]) > angle_) continue;
          links_.emplace_back(a, b);
          links_.emplace_back(b, a);
        }
      }
    }
    std::sort(links_.begin(), links_.end());
    links_.erase(std::unique(links_.begin(), links_.end()), links_.end());
  }

  void grow(std::uint32_t seed) {
    Spread spread(values_[seed]);
    spread.add(values_[seed]);
    cluster_of_[seed] = seed;
    std::vector<std::uint32_t> members{seed};
    for (std::size_t i = 0; i < members.size(); ++i) {
      auto link = std::lower_bound(links_.begin(), links_.end(), std::pair(members[i], 0u));
      for (; link != links_.end() && link->first == members[i]; ++link) {
        const std::uint32_t next = link->second;
        if (cluster_of_[next] != kNone || spread.with(values_[next]) > angle_) continue;
        spread.add(values_[next]);
        cluster_of_[next] = seed;
        members.push_back(next);
      }
    }
    if (members.size() == 1) cluster_of_[seed] = kNone;
  }

  double angle_;
  std::vector<AttributeId> ids_;  // ascending
  std::vector<Vec3d> values_;
  std::vector<std::uint32_t> corner_counts_, cluster_of_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links_;
};

AttributeId add_normal(AttributeLayer& normals, const Vec3d& sum, AttributeId fallback) {
  const Vec3d n = normalized(sum);
  if (n == Vec3d{}) return fallback;
  const auto id = static_cast<std::uint32_t>(normals.value_count());
  for (int i = 0; i < 3; ++i) normals.values.push_back(static_cast<float>(n[i]));
  return AttributeId{id};
}

// Gives the corners of one patch their new normals.
void settle_patch(AttributeLayer& normals, const Mesh& mesh, const std::vector<bool>& is_mixed,
                  std::span<const std::uint32_t> corners, double angle,
                  std::vector<AttributeId>& new_of_corner) {
  const AttributeId first = normals.of_corner[corners[0]];
  Vec3d sum;
  bool all_equal = true;
  for (std::uint32_t corner : corners) {
    new_of_corner[corner] = normals.of_corner[corner];
    sum += normal_at(normals, normals.of_corner[corner]);
    all_equal = all_equal && normals.of_corner[corner] == first;
  }
  if (all_equal) return;
  if (is_flat(normals, corners, sum, angle)) {
    const AttributeId one = add_normal(normals, sum, first);
    for (std::uint32_t corner : corners) new_of_corner[corner] = one;
    return;
  }
  ValueGathering gathering(normals, mesh, is_mixed, corners, angle);
  if (!gathering.joins_any()) return;
  gathering.gather();
  std::vector<Vec3d> sums(gathering.value_count());
  std::vector<AttributeId> joined(gathering.value_count(), kNoAttribute);
  for (std::uint32_t corner : corners) {
    const std::uint32_t c = gathering.cluster_of(normals.of_corner[corner]);
    if (c != kNone) sums[c] += normal_at(normals, normals.of_corner[corner]);
  }
  for (std::uint32_t corner : corners) {
    const std::uint32_t c = gathering.cluster_of(normals.of_corner[corner]);
    if (c == kNone) continue;
    if (joined[c] == kNoAttribute)
      joined[c] = add_normal(normals, sums[c], normals.of_corner[corner]);
    new_of_corner[corner] = joined[c];
  }
}

// (vertex, normal) pairs whose normal is another now.
std::size_t count_changes(const AttributeLayer& normals, const Mesh& mesh,
                          const std::vector<AttributeId>& new_of_corner) {
  std::vector<std::pair<std::size_t, AttributeId>> changed;
  for (std::size_t corner = 0; corner < new_of_corner.size(); ++corner) {
    const AttributeId before = normals.of_corner[corner], after = new_of_corner[corner];
    if (before == after || normal_at(normals, before) == normal_at(normals, after)) continue;
    changed.emplace_back(vertex_at(mesh, corner), before);
  }
  std::sort(changed.begin(), changed.end());
  return static_cast<std::size_t>(std::unique(changed.begin(), changed.end()) - changed.begin());
}

}  // namespace

std::size_t join_normals(AttributeLayer& normals, const Mesh& mesh, double angle_deg) {
  weld_layer(normals);
  const double angle = radians(angle_deg) * (1 + 1e-6);
  const std::uint32_t corner_count = static_cast<std::uint32_t>(normals.of_corner.size());
  std::vector<AttributeId> new_of_corner(corner_count, kNoAttribute);
  {
    const std::vector<bool> is_mixed = mixed_vertices(normals, mesh);
    const Clusters clusters = cluster_at_vertices(normals, mesh, angle);
    DisjointSets connected(clusters.count);
    for (std::uint32_t corner = 0; corner < corner_count; corner += 3) {
      connected.unite(clusters.of_corner[corner], clusters.of_corner[corner + 1]);
      connected.unite(clusters.of_corner[corner], clusters.of_corner[corner + 2]);
    }
    // A patch is its representative cluster's number; most numbers have no corners.
    Buckets in_patch = sort_into_buckets(corner_count, clusters.count, [&](std::uint32_t corner) {
      return connected.find(clusters.of_corner[corner]);
    });
    for (std::size_t patch = 0; patch < clusters.count; ++patch) {
      const std::span<const std::uint32_t> corners = in_patch.of(patch);
      if (!corners.empty()) settle_patch(normals, mesh, is_mixed, corners, angle, new_of_corner);
    }
  }
  const std::size_t changed = count_changes(normals, mesh, new_of_corner);
  normals.of_corner = std::move(new_of_corner);
  weld_layer(normals);
  return changed;
}

}  // namespace crease
