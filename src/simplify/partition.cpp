#include "simplify/partition.h"

#include "parallel/parallel.h"

#include <algorithm>

namespace crease::simplification {

namespace {

struct Centroid {
  std::int32_t sum[3];  // of the three positions, thirds of a grid unit; 3 * 2^29 fits
  std::uint32_t triangle;
};

// Where a cell is cut, by band: never the same place twice in a row.
constexpr double kCut[] = {0.5, 0.38, 0.62, 0.44, 0.56};

class Divider {
 public:
  Divider(std::uint32_t patch_triangles, int band)
      : patch_triangles_(patch_triangles), cut_(kCut[band % 5]) {}

  // Leaves are marked in `is_first`; every mark is its own byte, so threads do not meet.
  void divide(Centroid* begin, Centroid* end, std::vector<char>& is_first, std::size_t offset) {
    const std::size_t n = static_cast<std::size_t>(end - begin);
    if (n <= patch_triangles_) {
      is_first[offset] = 1;
      std::sort(begin, end,
                [](const Centroid& a, const Centroid& b) { return a.triangle < b.triangle; });
      return;
    }
    const int axis = longest_axis(begin, end);
    // Near the leaves an uneven cut only makes patches smaller than they need to be.
    const double share = n > 4 * patch_triangles_ ? cut_ : 0.5;
    const std::size_t left = static_cast<std::size_t>(share * static_cast<double>(n));
    std::nth_element(begin, begin + left, end, [axis](const Centroid& a, const Centroid& b) {
      return a.sum[axis] != b.sum[axis] ? a.sum[axis] < b.sum[axis] : a.triangle < b.triangle;
    });
    parallel_both([&] { divide(begin, begin + left, is_first, offset); },
                  [&] { divide(begin + left, end, is_first, offset + left); });
  }

 private:
  static int longest_axis(const Centroid* begin, const Centroid* end) {
    std::int64_t best = -1;
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
      std::int32_t low = begin->sum[i], high = low;
      for (const Centroid* c = begin; c != end; ++c) {
        low = std::min(low, c->sum[i]);
        high = std::max(high, c->sum[i]);
      }
      const std::int64_t extent = std::int64_t(high) - low;
      if (extent > best) {
        best = extent;
        axis = i;
      }
    }
    return axis;
  }

  std::size_t patch_triangles_;
  double cut_;
};

}  // namespace

Patches partition_triangles(std::span<const Vec3i> positions,
                            std::span<const std::uint32_t> vertices_of_triangle,
                            std::vector<std::uint32_t> triangles, std::uint32_t patch_triangles,
                            int band) {
  Patches patches;
  patches.triangles = std::move(triangles);
  const std::size_t n = patches.triangles.size();
  if (n <= patch_triangles) {
    patches.first = {0, static_cast<std::uint32_t>(n)};
    return patches;
  }

  std::vector<Centroid> centroids(n);
  parallel_ranges(n, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) {
      const std::uint32_t t = patches.triangles[i];
      const Vec3i& a = positions[vertices_of_triangle[3 * t]];
      const Vec3i& b = positions[vertices_of_triangle[3 * t + 1]];
      const Vec3i& c = positions[vertices_of_triangle[3 * t + 2]];
      // Grid coordinates lie within 30 bits, their halves' sum of three within 31.
      centroids[i] = {
          {a.x / 2 + b.x / 2 + c.x / 2, a.y / 2 + b.y / 2 + c.y / 2, a.z / 2 + b.z / 2 + c.z / 2},
          t};
    }
  });

  std::vector<char> is_first(n, 0);
  Divider(patch_triangles, band).divide(centroids.data(), centroids.data() + n, is_first, 0);
  for (std::size_t i = 0; i < n; ++i) {
    patches.triangles[i] = centroids[i].triangle;
    if (is_first[i]) patches.first.push_back(static_cast<std::uint32_t>(i));
  }
  patches.first.push_back(static_cast<std::uint32_t>(n));
  return patches;
}

}  // namespace crease::simplification
