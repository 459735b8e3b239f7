#include "mesh/strays.h"

#include <algorithm>
#include <array>
#include <optional>

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

struct Corners {
  Vec3d low, high;

  bool hold(const Vec3d& p) const {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z &&
           p.z <= high.z;
  }
  double longest() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

struct Step {
  std::size_t strays = 0;
  Corners others;
};

// Of the vertices within a box: those that are far from most of these, and the box of the others.
Step leave_strays(const Mesh& mesh, const Corners& box) {
  const double longest = box.longest();
  const auto bin_of = [&](const Vec3d& p, int axis) {
    const double at = (p[axis] - box.low[axis]) / longest * double(kBins);
    return std::min(static_cast<std::size_t>(at), kBins - 1);
  };
  std::array<Bins, 3> bins{};
  for (const Vec3d& p : mesh.positions) {
    if (!box.hold(p)) continue;
    for (int axis = 0; axis < 3; ++axis) ++bins[std::size_t(axis)][bin_of(p, axis)];
  }
  std::array<std::size_t, 3> first{};
  for (std::size_t axis = 0; axis < 3; ++axis) first[axis] = fullest_window(bins[axis]);
  Step step{.others = {box.high, box.low}};
  for (const Vec3d& p : mesh.positions) {
    if (!box.hold(p)) continue;
    bool is_inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside = is_inside && bin_of(p, axis) - first[std::size_t(axis)] < kWindow;
    }
    if (!is_inside) {
      ++step.strays;
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      step.others.low[axis] = std::min(step.others.low[axis], p[axis]);
      step.others.high[axis] = std::max(step.others.high[axis], p[axis]);
    }
  }
  return step;
}

struct Found {
  Strays strays;
  PointBox others;
};

// Again and again: without one that is a thousand times as far, others are seen to be far.
std::optional<Found> find(const Mesh& mesh) {
  const std::size_t count = mesh.vertex_count();
  if (count < kFewestVertices) return std::nullopt;
  const std::size_t most = std::max(kFewest, count / kFewShare);
  const PointBox whole = box_of(mesh.positions);
  Corners box{whole.low, whole.low + whole.size};
  for (const Vec3d& p : mesh.positions) {  // the sum above is rounded
    for (int i = 0; i < 3; ++i) box.high[i] = std::max(box.high[i], p[i]);
  }
  Strays strays{.longest = whole.longest};
  while (box.longest() > 0) {
    const Step step = leave_strays(mesh, box);
    if (step.strays == 0 || strays.count + step.strays > most) break;
    if (!(step.others.longest() * kTimesSmaller < box.longest())) break;
    strays.count += step.strays;
    box = step.others;
  }
  if (strays.count == 0) return std::nullopt;
  strays.longest_without = box.longest();
  return Found{strays, {box.low, box.high - box.low, box.longest()}};
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
