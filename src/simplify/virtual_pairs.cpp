// Pairs without an edge: near vertices of different parts (Garland's aggregation), so that parts
// join before they vanish.
#include "simplify/patch_simplifier.h"

#include <algorithm>
#include <cmath>

namespace crease::simplification {

namespace {

// How many cells away a partner is looked for. Cells hold about two vertices, so "near" is also
// relative to how dense the vertices are.
constexpr int kShells = 3;

class Cells {
 public:
  Cells(const Vec3d& low, double size) : low_(low), size_(size) {}
  std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) const {
    return (std::uint64_t(x + 8) << 42) ^ (std::uint64_t(y + 8) << 21) ^ std::uint64_t(z + 8);
  }
  void cell(const Vec3d& p, std::int64_t (&c)[3]) const {
    for (int i = 0; i < 3; ++i) c[i] = static_cast<std::int64_t>((p[i] - low_[i]) / size_);
  }
  double size() const { return size_; }

 private:
  Vec3d low_;
  double size_;
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
  const Cells cells(low, std::max(std::min(density, steering_.virtual_distance), longest / 1e6));

  std::vector<std::pair<std::uint64_t, Index>> sorted(n);
  for (Index v = 0; v < n; ++v) {
    std::int64_t c[3];
    cells.cell(vertices_[v].position, c);
    sorted[v] = {cells.key(c[0], c[1], c[2]), v};
  }
  std::sort(sorted.begin(), sorted.end());

  const double limit2 = steering_.virtual_distance * steering_.virtual_distance;
  const std::size_t edge_count = pairs_.size();
  for (Index v = 0; v < n; ++v) {
    if (vertices_[v].locked) continue;
    std::int64_t c[3];
    cells.cell(vertices_[v].position, c);
    Index best = kNone;
    double best2 = limit2;
    for (int shell = 0; shell <= kShells; ++shell) {
      const double reached = (shell - 1) * cells.size();
      if (shell > 1 && reached * reached > best2) break;
      for (int x = -shell; x <= shell; ++x) {
        for (int y = -shell; y <= shell; ++y) {
          const bool inside = std::abs(x) < shell && std::abs(y) < shell;
          for (int z = -shell; z <= shell; z += inside ? std::max(1, 2 * shell) : 1) {
            const std::uint64_t key = cells.key(c[0] + x, c[1] + y, c[2] + z);
            auto at = std::lower_bound(sorted.begin(), sorted.end(), std::pair(key, Index(0)));
            for (; at != sorted.end() && at->first == key; ++at) {
              const Index u = at->second;
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
