#include "mesh/guess_up.h"

#include "mesh/box_of.h"
#include "mesh/strays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease {

namespace {

constexpr double kClearly = 0.15;
constexpr double kFlat = 1e-3;            // of the longest side: a drawing, seen from the front
constexpr double kAllOneWay = 0.99;       // of a field of heights
constexpr double kLowest = 0.02;          // of the height are the lowest points
constexpr double kLowestAtLeast = 0.004;  // of the longest side
constexpr int kCells = 20;                // along the longest side, to compare with a mirror image
constexpr int kMostSteps = 2 * kCells;    // along an edge

using Point = std::array<double, 2>;

double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Of the convex hull (Andrew's monotone chain).
double hull_area(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return 0;
  std::vector<Point> hull;
  for (const bool is_upper : {false, true}) {
    const std::size_t begin = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    if (!is_upper) std::reverse(points.begin(), points.end());
  }
  double twice = 0;
  for (std::size_t i = 0; i + 1 < hull.size(); ++i) twice += turn(hull[0], hull[i], hull[i + 1]);
  return twice / 2;
}

bool is_in(const PointBox& box, const Vec3d& p) {
  for (int i = 0; i < 3; ++i) {
    if (p[i] < box.low[i] || p[i] - box.low[i] > box.size[i]) return false;
  }
  return true;
}

// Which cells of a grid the surface goes through, but for triangles of strays.
class Cells {
 public:
  Cells(const Mesh& mesh, const PointBox& box)
      : middle_(box.low + box.size * 0.5), side_(box.longest) {
    for (const Triangle& t : mesh.triangles) {
      std::array<Vec3d, 3> p;
      for (std::size_t c = 0; c < 3; ++c) p[c] = mesh.positions[index_of(t[c])];
      if (is_in(box, p[0]) && is_in(box, p[1]) && is_in(box, p[2])) fill(p);
    }
  }

  // The share of cells that have none in or beside their place in the mirror image.
  double unlike_its_mirror(std::size_t axis) const {
    std::size_t all = 0, alone = 0;
    for (int x = 0; x < kCells; ++x) {
      for (int y = 0; y < kCells; ++y) {
        for (int z = 0; z < kCells; ++z) {
          std::array<int, 3> at{x, y, z};
          if (!is_set(at)) continue;
          ++all;
          at[axis] = kCells - 1 - at[axis];
          alone += is_near(at) ? 0 : 1;
        }
      }
    }
    return all == 0 ? 0 : double(alone) / double(all);
  }

 private:
  void fill(const std::array<Vec3d, 3>& p) {
    const double longest =
        std::max({length(p[1] - p[0]), length(p[2] - p[1]), length(p[0] - p[2])});
    const int steps = std::clamp(int(std::ceil(2 * kCells * longest / side_)), 1, kMostSteps);
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        set(p[0] + (p[1] - p[0]) * (double(i) / steps) + (p[2] - p[0]) * (double(j) / steps));
      }
    }
  }
  void set(const Vec3d& p) {
    std::array<int, 3> at{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double share = (p[int(c)] - middle_[int(c)]) / side_ + 0.5;
      at[c] = std::clamp(int(share * kCells), 0, kCells - 1);
    }
    cells_[std::size_t(at[0])][std::size_t(at[1])] |= 1u << at[2];
  }
  bool is_set(const std::array<int, 3>& at) const {
    for (const int i : at) {
      if (i < 0 || i >= kCells) return false;
    }
    return (cells_[std::size_t(at[0])][std::size_t(at[1])] >> at[2] & 1u) != 0;
  }
  bool is_near(std::array<int, 3> at) const {
    if (is_set(at)) return true;
    for (int& i : at) {
      for (const int step : {-1, 1}) {
        i += step;
        if (is_set(at)) return true;
        i -= step;
      }
    }
    return false;
  }

  Vec3d middle_;
  double side_;
  std::array<std::array<std::uint32_t, kCells>, kCells> cells_{};
};

// Of the shadow, the part over the hull of the lowest points, less half of that of the highest.
double stands_on(const Mesh& mesh, const PointBox& box, int axis) {
  const double height = box.size[axis];
  const double band = std::max(kLowest * height, kLowestAtLeast * box.longest);
  std::vector<Point> all, lowest, highest;
  for (const Vec3d& p : mesh.positions) {
    if (!is_in(box, p)) continue;
    const Point q{p[0] - box.low[0], p[3 - axis] - box.low[3 - axis]};
    all.push_back(q);
    if (p[axis] < box.low[axis] + band) lowest.push_back(q);
    if (p[axis] > box.low[axis] + height - band) highest.push_back(q);
  }
  const double shadow = hull_area(std::move(all));
  if (!(shadow > 0)) return 0;
  return (hull_area(std::move(lowest)) - hull_area(std::move(highest)) / 2) / shadow;
}

// 1: every triangle faces up, or every one down.
double one_way(const Mesh& mesh, const PointBox& box, int axis) {
  double sum = 0, all = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d& a = mesh.positions[index_of(t[0])];
    const Vec3d& b = mesh.positions[index_of(t[1])];
    const Vec3d& c = mesh.positions[index_of(t[2])];
    if (!is_in(box, a) || !is_in(box, b) || !is_in(box, c)) continue;
    const double area = cross(b - a, c - a)[axis];
    sum += area;
    all += std::abs(area);
  }
  return all > 0 ? std::abs(sum) / all : 0;
}

}  // namespace

UpAxis guess_up(const Mesh& mesh, UpAxis usual) {
  constexpr int y = 1, z = 2;
  if (mesh.positions.empty()) return usual;
  // A stray is no part of how the others stand.
  const PointBox box = box_without_strays(mesh).value_or(box_of(mesh.positions));
  for (const auto& [axis, other] : {std::pair(y, UpAxis::Z), std::pair(z, UpAxis::Y)}) {
    if (box.size[axis] <= kFlat * box.longest) return other;
  }
  const bool field_of_y = one_way(mesh, box, y) > kAllOneWay,
             field_of_z = one_way(mesh, box, z) > kAllOneWay;
  if (field_of_y != field_of_z) return field_of_y ? UpAxis::Y : UpAxis::Z;

  const Cells cells(mesh, box);
  const auto speaks_for = [&](int axis) {
    return stands_on(mesh, box, axis) + cells.unlike_its_mirror(std::size_t(axis)) / 2;
  };
  const double ahead = speaks_for(z) - speaks_for(y);
  if (usual == UpAxis::Z) return ahead < -kClearly ? UpAxis::Y : UpAxis::Z;
  return ahead > kClearly ? UpAxis::Z : UpAxis::Y;
}

}  // namespace crease
