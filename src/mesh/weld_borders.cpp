#include "mesh/weld_borders.h"

#include "mesh/clean.h"
#include "mesh/mix.h"
#include "mesh/strays.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

namespace crease {

namespace {

// Around a vertex of a closed surface every edge is left by one triangle and reached by another, so
// that what follows the vertex in its triangles is, all together, what precedes it.
std::vector<bool> vertices_at_borders(const Mesh& mesh) {
  std::vector<std::uint64_t> balance(mesh.vertex_count(), 0);
  for (const Triangle& t : mesh.triangles) {
    const std::array hash{mix(index_of(t[0])), mix(index_of(t[1])), mix(index_of(t[2]))};
    for (std::size_t c = 0; c < 3; ++c) {
      balance[index_of(t[c])] += hash[(c + 1) % 3] - hash[(c + 2) % 3];
    }
  }
  std::vector<bool> is_border(balance.size());
  for (std::size_t v = 0; v < balance.size(); ++v) is_border[v] = balance[v] != 0;
  return is_border;
}

void leave_short_edges(const Mesh& mesh, double distance, std::vector<bool>& may_join) {
  const double rounding = rounding_of(mesh);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t a = index_of(t[c]), b = index_of(t[(c + 1) % 3]);
      if (!may_join[a] && !may_join[b]) continue;
      const double side = length(mesh.positions[a] - mesh.positions[b]);
      if (side <= rounding || side > 2 * distance) continue;
      may_join[a] = may_join[b] = false;
    }
  }
}

// Points by cells that are several distances wide, so that few look into the next one. A flat hash
// table of lists; cells that collide share one, in which distances tell.
class NearPoints {
 public:
  NearPoints(const std::vector<Vec3d>& positions, std::size_t most, double distance)
      : positions_(positions),
        distance_(distance),
        width_(4 * distance),
        first_(std::bit_ceil(2 * most + 1), kNone),
        next_(positions.size(), kNone) {}

  // A point within the distance, or VertexId{kNone}: then this one is added.
  VertexId find_or_add(VertexId v) {
    const Vec3d& p = positions_[index_of(v)];
    const std::array<std::int64_t, 3> low = cell_of(p, -distance_), high = cell_of(p, distance_);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          for (std::uint32_t i = first_of({x, y, z}); i != kNone; i = next_[i]) {
            if (length(positions_[i] - p) <= distance_) return VertexId{i};
          }
        }
      }
    }
    std::uint32_t& first = first_of(cell_of(p, 0));
    next_[index_of(v)] = std::exchange(first, static_cast<std::uint32_t>(index_of(v)));
    return VertexId{kNone};
  }

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3d& p, double by) const {
    return {std::llround((p.x + by) / width_), std::llround((p.y + by) / width_),
            std::llround((p.z + by) / width_)};
  }
  std::uint32_t& first_of(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t key = 0;
    for (const std::int64_t i : cell) key = mix(key ^ static_cast<std::uint64_t>(i));
    return first_[key & (first_.size() - 1)];
  }

  const std::vector<Vec3d>& positions_;
  double distance_, width_;
  std::vector<std::uint32_t> first_;  // of a list
  std::vector<std::uint32_t> next_;   // per vertex
};

}  // namespace

double rounding_of(const Mesh& mesh) {
  return std::max(std::ldexp(longest_without_strays(mesh), -22), finest_step(mesh));
}

NearBorders find_near_borders(const Mesh& mesh, double distance) {
  NearBorders near;
  std::vector<bool> may_join = vertices_at_borders(mesh);
  for (const bool is_border : may_join) near.border_count += is_border;
  if (!(distance > 0)) return near;
  leave_short_edges(mesh, distance, may_join);
  near.first.reserve(mesh.vertex_count());
  NearPoints points(mesh.positions, near.border_count, distance);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const VertexId found = may_join[v] ? points.find_or_add(VertexId{v}) : VertexId{kNone};
    near.count += found != VertexId{kNone};
    near.first.push_back(found == VertexId{kNone} ? VertexId{v} : found);
  }
  return near;
}

std::size_t weld_borders(Mesh& mesh, const NearBorders& near) {
  if (near.count == 0) return 0;  // and `first` may be empty
  const auto becomes = [&](VertexId v) { return near.first[index_of(v)]; };
  const bool keeps_some =
      std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        const VertexId a = becomes(t[0]), b = becomes(t[1]), c = becomes(t[2]);
        return a != b && b != c && c != a;
      });
  if (!keeps_some) return 0;
  for (Triangle& t : mesh.triangles) {
    for (VertexId& v : t) v = becomes(v);
  }
  return drop_isolated_vertices(mesh);
}

}  // namespace crease
