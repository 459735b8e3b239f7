#include "mesh/strays.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace crease {

namespace {

constexpr double kTimesSmaller = 16;
constexpr std::size_t kFewestVertices = 64, kFewest = 3, kFewShare = 1000;

// Bins over the longest side. Whatever is shorter than its 16th lies in five that follow each
// other.
constexpr std::size_t kBins = 64, kWindow = 5;
static_assert(kBins / kTimesSmaller + 1 == kWindow);

using Bins = std::array<std::size_t, kBins>;

// Where the five begin that hold most.
std::size_t fullest_window(const Bins& bins) {
  std::size_t best = 0, most = 0;
  for (std::size_t first = 0; first + kWindow <= kBins; ++first) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kWindow; ++i) count += bins[first + i];
    if (count <= most) continue;
    most = count;
    best = first;
  }
  return best;
}

struct Found {
  Strays strays;
  PointBox others;
};

std::optional<Found> find(const Mesh& mesh) {
  const std::size_t count = mesh.vertex_count();
  if (count < kFewestVertices) return std::nullopt;
  const PointBox box = box_of(mesh.positions);
  if (!(box.longest > 0)) return std::nullopt;
  const auto bin_of = [&](const Vec3d& p, int axis) {
    const double at = (p[axis] - box.low[axis]) / box.longest * double(kBins);
    return std::min(static_cast<std::size_t>(at), kBins - 1);
  };
  std::array<Bins, 3> bins{};
  for (const Vec3d& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) ++bins[std::size_t(axis)][bin_of(p, axis)];
  }
  std::array<std::size_t, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis) first[axis] = fullest_window(bins[axis]);
  Strays strays{.longest = box.longest};
  std::vector<Vec3d> others;  // the corners of the box around them
  for (const Vec3d& p : mesh.positions) {
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside = is_inside && bin_of(p, axis) - first[std::size_t(axis)] < kWindow;
    }
    if (!is_inside) {
      ++strays.count;
      continue;
    }
    if (others.empty()) others = {p, p};
    for (int axis = 0; axis < 3; ++axis) {
      others[0][axis] = std::min(others[0][axis], p[axis]);
      others[1][axis] = std::max(others[1][axis], p[axis]);
    }
  }
  if (strays.count == 0 || strays.count > std::max(kFewest, count / kFewShare)) {
    return std::nullopt;
  }
  const PointBox without = box_of(others);
  strays.longest_without = without.longest;
  if (!(strays.longest_without * kTimesSmaller < strays.longest)) return std::nullopt;
  return Found{strays, without};
}

}  // namespace

std::optional<Strays> find_strays(const Mesh& mesh) {
  const std::optional<Found> found = find(mesh);
  return found ? std::optional(found->strays) : std::nullopt;
}

std::optional<PointBox> box_without_strays(const Mesh& mesh) {
  const std::optional<Found> found = find(mesh);
  return found ? std::optional(found->others) : std::nullopt;
}

double longest_without_strays(const Mesh& mesh) {
  const std::optional<PointBox> others = box_without_strays(mesh);
  return (others ? *others : box_of(mesh.positions)).longest;
}

}  // namespace crease
