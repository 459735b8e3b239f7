// Pairs without an edge: near vertices of different parts (Garland's aggregation), so that parts
// join before they vanish.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

namespace {

// How many cells away a partner is looked for. Cells hold about two vertices, so "near" is also
// relative to how dense the vertices are.
constexpr int kCells = 2;

// Where vertices crowd, no more than these are looked at for each.
constexpr std::uint32_t kCandidates = 200;

// Vertices by the cell of a grid that they lie in.
class Cells {
 public:
  Cells(const Vec3d& low, const Vec3d& high, double size, std::size_t vertex_count) : low_(low) {
    // Never many more cells than vertices.
    const double most = 8 * static_cast<double>(vertex_count) + 64;
    for (size_ = size;; size_ *= 1.5) {
      double cells = 1;
      for (int i = 0; i < 3; ++i) cells *= std::floor((high[i] - low[i]) / size_) + 1;
      if (cells <= most) break;
    }
    for (int i = 0; i < 3; ++i) count_[i] = static_cast<int>((high[i] - low[i]) / size_) + 1;
    first_.assign(std::size_t(count_[0]) * count_[1] * count_[2] + 1, 0);
  }

  double size() const { return size_; }
  int coordinate(const Vec3d& p, int axis) const {
    return std::min(static_cast<int>((p[axis] - low_[axis]) / size_), count_[axis] - 1);
  }

  // Twice over all vertices: count() them, then, after start(), put() them, in ascending order.
  void count(const Vec3d& p) { ++first_[cell_of(p)]; }
  void start() {
    std::uint32_t sum = 0;
    for (std::uint32_t& first : first_) sum = first += sum;  // ends
    vertices_.resize(sum);
  }
  void put_backwards(const Vec3d& p, std::uint32_t v) { vertices_[--first_[cell_of(p)]] = v; }

  // Calls visit(vertex) for the first `most` of those at most `reach` cells away along every axis:
  // cells that differ in x alone lie together.
  template <typename Visit>
  void near(const int cell[3], int reach, std::uint32_t most, Visit visit) const {
    const int x_begin = std::max(0, cell[0] - reach);
    const int x_end = std::min(count_[0], cell[0] + reach + 1);
    for (int z = std::max(0, cell[2] - reach); z < std::min(count_[2], cell[2] + reach + 1); ++z) {
      for (int y = std::max(0, cell[1] - reach); y < std::min(count_[1], cell[1] + reach + 1);
           ++y) {
        const std::uint32_t begin = first_[index(x_begin, y, z)];
        const std::uint32_t end = std::min(first_[index(x_end, y, z)], begin + most);
        for (std::uint32_t i = begin; i != end; ++i) visit(vertices_[i]);
        most -= end - begin;
      }
    }
  }

 private:
  std::size_t index(int x, int y, int z) const {
    return (std::size_t(z) * count_[1] + y) * count_[0] + x;
  }
  std::size_t cell_of(const Vec3d& p) const {
    return index(coordinate(p, 0), coordinate(p, 1), coordinate(p, 2));
  }

  Vec3d low_;
  double size_ = 1;
  int count_[3] = {1, 1, 1};
  std::vector<std::uint32_t> first_;  // in vertices_, by cell
  std::vector<std::uint32_t> vertices_;
};

}  // namespace

void PatchSimplifier::find_virtual_pairs() {
  const Index n = static_cast<Index>(vertices_.size());
  std::vector<Index> part(n);
  bool several = false, any_joins = false;
  const auto joins = [&](Index v) {
    return !vertices_[v].locked && work_->triangles_of_part[part[v]] < steering_.joins_below;
  };
  for (Index v = 0; v < n; ++v) {
    part[v] = work_->part_of_vertex[vertices_[v].global];
    several = several || part[v] != part[0];
    any_joins = any_joins || joins(v);
  }
  if (!several || !any_joins) return;

  Vec3d low = positions_[0], high = low;
  for (const Vec3d& p : positions_) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  const Vec3d extent = high - low;
  const double longest = std::max({extent.x, extent.y, extent.z, 1.0});
  double volume = 1;
  for (int i = 0; i < 3; ++i) volume *= std::max(extent[i], longest / std::sqrt(double(n)));
  const double density = std::cbrt(2 * volume / n);
  Cells cells(low, high, std::max(std::min(density, steering_.virtual_distance), longest / 1e6), n);
  for (const Vec3d& p : positions_) cells.count(p);
  cells.start();
  for (Index v = n; v-- > 0;) cells.put_backwards(positions_[v], v);

  const std::vector<float>& area = work_->area_of_part;
  const double limit2 = steering_.virtual_distance * steering_.virtual_distance;
  const std::size_t edge_count = pairs_.size();
  for (Index v = 0; v < n; ++v) {
    if (!joins(v)) continue;
    int c[3];
    for (int i = 0; i < 3; ++i) c[i] = cells.coordinate(positions_[v], i);
    Index best = kNone;
    double best2 = limit2;
    for (int reach = 1; reach <= kCells; ++reach) {
      const double searched = (reach - 1) * cells.size();
      if (searched * searched > best2) break;
      cells.near(c, reach, kCandidates, [&](Index u) {
        if (part[u] == part[v] || vertices_[u].locked) return;
        if (!joins(u) && area[part[u]] < area[part[v]]) return;
        const Vec3d gap = positions_[u] - positions_[v];
        const double gap2 = dot(gap, gap);
        if (gap2 > best2 || (gap2 == best2 && u > best)) return;
        best2 = gap2;
        best = u;
      });
    }
    if (best != kNone) pairs_.emplace_back(std::min(v, best), std::max(v, best));
  }
  std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(edge_count), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin() + static_cast<std::ptrdiff_t>(edge_count), pairs_.end()),
               pairs_.end());
}

}  // namespace crease::simplification
