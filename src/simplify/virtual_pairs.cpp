// Pairs without an edge: near vertices of different parts (Garland's aggregation), so that parts
// join before they vanish.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

namespace {

// How many cells away a partner is looked for. Cells hold about two vertices, so "near" is also
// relative to how dense the vertices are.
constexpr int kShells = 2;

// Where vertices crowd, no more than these are looked at for each.
constexpr int kCandidates = 200;

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

  // Empty outside of the grid.
  std::span<const std::uint32_t> at(int x, int y, int z) const {
    if (x < 0 || y < 0 || z < 0 || x >= count_[0] || y >= count_[1] || z >= count_[2]) return {};
    const std::size_t cell = index(x, y, z);
    return std::span(vertices_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
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
  bool several = false;
  for (Index v = 0; v < n; ++v) {
    part[v] = work_->part_of_vertex[vertices_[v].global];
    several = several || part[v] != part[0];
  }
  if (!several) return;

  Vec3d low = vertices_[0].position, high = low;
  for (const Vertex& v : vertices_) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], v.position[i]);
      high[i] = std::max(high[i], v.position[i]);
    }
  }
  const Vec3d extent = high - low;
  const double longest = std::max({extent.x, extent.y, extent.z, 1.0});
  double volume = 1;
  for (int i = 0; i < 3; ++i) volume *= std::max(extent[i], longest / std::sqrt(double(n)));
  const double density = std::cbrt(2 * volume / n);
  Cells cells(low, high, std::max(std::min(density, steering_.virtual_distance), longest / 1e6), n);
  for (const Vertex& v : vertices_) cells.count(v.position);
  cells.start();
  for (Index v = n; v-- > 0;) cells.put_backwards(vertices_[v].position, v);

  const double limit2 = steering_.virtual_distance * steering_.virtual_distance;
  const std::size_t edge_count = pairs_.size();
  for (Index v = 0; v < n; ++v) {
    if (vertices_[v].locked) continue;
    int c[3];
    for (int i = 0; i < 3; ++i) c[i] = cells.coordinate(vertices_[v].position, i);
    Index best = kNone;
    double best2 = limit2;
    int candidates = 0;
    for (int shell = 0; shell <= kShells; ++shell) {
      const double reached = (shell - 1) * cells.size();
      if (shell > 1 && reached * reached > best2) break;
      for (int x = -shell; x <= shell; ++x) {
        for (int y = -shell; y <= shell; ++y) {
          const bool inside = std::abs(x) < shell && std::abs(y) < shell;
          for (int z = -shell; z <= shell; z += inside ? std::max(1, 2 * shell) : 1) {
            for (Index u : cells.at(c[0] + x, c[1] + y, c[2] + z)) {
              if (++candidates > kCandidates) break;
              if (part[u] == part[v] || vertices_[u].locked) continue;
              const Vec3d gap = vertices_[u].position - vertices_[v].position;
              const double gap2 = dot(gap, gap);
              if (gap2 > best2 || (gap2 == best2 && u > best)) continue;
              best2 = gap2;
              best = u;
            }
          }
        }
      }
    }
    if (best != kNone) pairs_.emplace_back(std::min(v, best), std::max(v, best));
  }
  std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(edge_count), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin() + static_cast<std::ptrdiff_t>(edge_count), pairs_.end()),
               pairs_.end());
}

}  // namespace crease::simplification
