#include "simplify/partition.h"

#include "parallel/parallel.h"

#include <algorithm>
#include <array>

namespace crease::simplification {

namespace {

struct Centroid {
  std::int32_t sum[3];  // of the three positions, thirds of a grid unit; 3 * 2^29 fits
  std::uint32_t triangle;
};

// Where a cell is cut, by band: never the same place twice in a row.
constexpr double kCut[] = {0.5, 0.38, 0.62, 0.44, 0.56};

// A cell is cut across another axis than its longest one where that cuts fewer than this share of
// the triangles: rods that lie in a layer below a dome are not sliced lengthwise because of the
// dome. Counted among so many.
constexpr double kFarFewer = 0.5;
constexpr std::size_t kSample = 2048;

// Cuts cells of centroids in two until they are small enough. A cell's centroids stay in the order
// of their triangles.
class Divider {
 public:
  Divider(std::span<const Vec3i> positions, std::span<const std::uint32_t> vertices_of_triangle,
          std::uint32_t patch_triangles, int band, std::size_t n)
      : positions_(positions),
        vertices_of_triangle_(vertices_of_triangle),
        patch_triangles_(patch_triangles),
        cut_(kCut[band % 5]),
        scratch_(n),
        is_first_(n, 0) {}

  // `offset`: of the cell in the whole.
  void divide(std::span<Centroid> cell, std::size_t offset) {
    const std::size_t n = cell.size();
    if (n <= patch_triangles_) {
      is_first_[offset] = 1;
      return;
    }
    // Near the leaves an uneven cut only makes patches smaller than they need to be.
    const double share = n > 4 * patch_triangles_ ? cut_ : 0.5;
    const Axis axis = axis_to_cut(cell, share);
    const std::size_t wanted = static_cast<std::size_t>(share * static_cast<double>(n));
    const std::size_t left = separate(cell, axis, wanted, offset);
    parallel_both([&] { divide(cell.first(left), offset); },
                  [&] { divide(cell.subspan(left), offset + left); });
  }

  // Whether a patch begins at this centroid; every mark is its own byte, so threads do not meet.
  const std::vector<char>& is_first() const { return is_first_; }

 private:
  struct Axis {
    int index = 0;
    std::int32_t low = 0, high = 0;
  };

  // The longest, or the one that cuts far fewer triangles.
  Axis axis_to_cut(std::span<const Centroid> cell, double share) const {
    const std::array<Axis, 3> axes = axes_of(cell);
    const auto extent = [](const Axis& axis) { return std::int64_t(axis.high) - axis.low; };
    Axis best = axes[0];
    for (const Axis& axis : axes) {
      if (extent(axis) > extent(best)) best = axis;
    }
    const std::array<std::size_t, 3> cut = count_cut(cell, share);
    const auto longest = static_cast<std::size_t>(best.index);
    std::size_t fewest = cut[longest];
    for (std::size_t i = 0; i < 3; ++i) {
      if (cut[i] >= fewest || double(cut[i]) >= kFarFewer * double(cut[longest])) continue;
      fewest = cut[i];
      best = axes[i];
    }
    return best;
  }

  static std::array<Axis, 3> axes_of(std::span<const Centroid> cell) {
    std::array<Axis, 3> axes;
    for (int i = 0; i < 3; ++i) axes[i] = {i, cell[0].sum[i], cell[0].sum[i]};
    for (const Centroid& c : cell) {
      for (int i = 0; i < 3; ++i) {
        axes[i].low = std::min(axes[i].low, c.sum[i]);
        axes[i].high = std::max(axes[i].high, c.sum[i]);
      }
    }
    return axes;
  }

  // Per axis how many of a sample of triangles lie on both sides of the cut, or right on it: which
  // of these go left says their order alone.
  std::array<std::size_t, 3> count_cut(std::span<const Centroid> cell, double share) const {
    const std::size_t stride = std::max<std::size_t>(1, cell.size() / kSample);
    std::array<std::size_t, 3> count{};
    for (int i = 0; i < 3; ++i) {
      std::vector<std::int32_t> sorted;
      for (std::size_t k = 0; k < cell.size(); k += stride) sorted.push_back(cell[k].sum[i]);
      const auto middle =
          sorted.begin() + static_cast<std::ptrdiff_t>(share * double(sorted.size()));
      std::nth_element(sorted.begin(), middle, sorted.end());
      for (std::size_t k = 0; k < cell.size(); k += stride) {
        std::size_t below = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t v = vertices_of_triangle_[3 * std::size_t(cell[k].triangle) + c];
          below += std::int64_t(positions_[v][i] / 2) * 3 < *middle;
        }
        count[static_cast<std::size_t>(i)] += below % 3 != 0 || cell[k].sum[i] == *middle;
      }
    }
    return count;
  }

  // How many of a cell's centroids go left where `wanted` should, but all from `none` to `all` are
  // at one place: these stay together, unless they are the whole cell.
  static std::size_t without_parting(std::size_t cell_size, std::size_t wanted, std::size_t none,
                                     std::size_t all) {
    if (none == 0 && all == cell_size) return wanted;
    if (none == 0) return all;
    return all == cell_size || wanted - none < all - wanted ? none : all;
  }

  // Puts about `left` centroids that are lowest on the axis first, both sides in their old order;
  // returns how many. A histogram finds the bucket with the border in it, only that bucket is
  // looked at closely.
  std::size_t separate(std::span<Centroid> cell, const Axis& axis, std::size_t left,
                       std::size_t offset) {
    constexpr std::size_t kBuckets = 1024;
    std::array<std::uint32_t, kBuckets> count{};
    const double extent = double(axis.high) - double(axis.low);
    const double scale = extent > 0 ? (kBuckets - 0.5) / extent : 0;
    const auto bucket_of = [&](std::int32_t x) {
      return static_cast<std::size_t>((double(x) - double(axis.low)) * scale);
    };
    for (const Centroid& c : cell) ++count[bucket_of(c.sum[axis.index])];
    std::size_t border_bucket = 0, below = 0;
    while (below + count[border_bucket] <= left) below += count[border_bucket++];

    std::vector<std::int32_t> close;
    close.reserve(count[border_bucket]);
    for (const Centroid& c : cell) {
      if (bucket_of(c.sum[axis.index]) == border_bucket) close.push_back(c.sum[axis.index]);
    }
    const std::size_t rank = left - below;
    const auto at_rank = close.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(close.begin(), at_rank, close.end());
    const std::int32_t border = *at_rank;
    // So many of those that lie on the border go left.
    std::size_t on_border_left =
        rank - static_cast<std::size_t>(std::count_if(close.begin(), at_rank,
                                                      [&](std::int32_t x) { return x < border; }));

    const std::size_t none = left - on_border_left;
    const std::size_t all =
        none + static_cast<std::size_t>(std::count(close.begin(), close.end(), border));
    left = without_parting(cell.size(), left, none, all);
    on_border_left = left - none;

    Centroid* to_left = cell.data();
    Centroid* to_right = &scratch_[offset];
    for (const Centroid& c : cell) {
      const std::int32_t x = c.sum[axis.index];
      const bool goes_left = x < border || (x == border && on_border_left > 0);
      on_border_left -= goes_left && x == border;
      Centroid* to = goes_left ? to_left : to_right;
      *to = c;
      to_left += goes_left;
      to_right += !goes_left;
    }
    std::copy(&scratch_[offset], to_right, to_left);
    return left;
  }

  std::span<const Vec3i> positions_;
  std::span<const std::uint32_t> vertices_of_triangle_;
  std::size_t patch_triangles_;
  double cut_;
  std::vector<Centroid> scratch_;
  std::vector<char> is_first_;
};

// The triangles of a part that a patch can hold all lie where its middle is.
void keep_parts_whole(std::span<Centroid> centroids,
                      std::span<const std::uint32_t> vertices_of_triangle,
                      std::span<const std::uint32_t> part_of_vertex,
                      std::uint32_t patch_triangles) {
  struct Part {
    std::int64_t sum[3] = {0, 0, 0};
    std::int64_t count = 0;
  };
  std::vector<Part> parts;
  std::vector<std::uint32_t> number(part_of_vertex.size(), kNone);  // by a part's name
  std::vector<std::uint32_t> part_of_centroid;
  part_of_centroid.reserve(centroids.size());
  for (const Centroid& c : centroids) {
    const std::uint32_t name = part_of_vertex[vertices_of_triangle[3 * std::size_t(c.triangle)]];
    if (number[name] == kNone) {
      number[name] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    part_of_centroid.push_back(number[name]);
    Part& part = parts[number[name]];
    ++part.count;
    for (int i = 0; i < 3; ++i) part.sum[i] += c.sum[i];
  }
  parallel_ranges(centroids.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k != end; ++k) {
      const Part& part = parts[part_of_centroid[k]];
      if (part.count > patch_triangles) continue;
      for (int i = 0; i < 3; ++i) {
        centroids[k].sum[i] = static_cast<std::int32_t>(part.sum[i] / part.count);
      }
    }
  });
}

}  // namespace

Patches partition_triangles(std::span<const Vec3i> positions,
                            std::span<const std::uint32_t> vertices_of_triangle,
                            std::vector<std::uint32_t> triangles, std::uint32_t patch_triangles,
                            int band, std::span<const std::uint32_t> part_of_vertex) {
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

  if (!part_of_vertex.empty()) {
    keep_parts_whole(centroids, vertices_of_triangle, part_of_vertex, patch_triangles);
  }
  Divider divider(positions, vertices_of_triangle, patch_triangles, band, n);
  divider.divide(centroids, 0);
  for (std::size_t i = 0; i < n; ++i) {
    patches.triangles[i] = centroids[i].triangle;
    if (divider.is_first()[i]) patches.first.push_back(static_cast<std::uint32_t>(i));
  }
  patches.first.push_back(static_cast<std::uint32_t>(n));
  return patches;
}

}  // namespace crease::simplification
