#include "runtime/folds.h"

#include "runtime/cut_drawing.h"

#include <algorithm>
#include <array>

namespace crease {

namespace {

bool is_fold(const ActiveCut& cut, const ActiveTriangles& part, std::uint32_t triangle) {
  constexpr float kAway = -0.02f;  // a cosine: what is seen from the edge is none
  const Vec3f plane = geometric_normal_of(cut, part, triangle);
  if (part.is_derived[triangle] != 0 || plane == Vec3f{}) return false;
  const std::uint32_t layer = cut.normal_layer();
  std::array<std::uint32_t, 3> values{};
  for (std::uint32_t k = 0; k < 3; ++k) {
    values[k] = static_cast<std::uint32_t>(cut.value_index(part, 3 * triangle + k, layer));
  }
  std::array<Vec3f, 3> normals;
  cut.hierarchy().layers[layer].values.directions(values, normals);
  return std::all_of(normals.begin(), normals.end(),
                     [&](const Vec3f& n) { return dot(n, plane) < kAway; });
}

std::uint32_t widest_corner(const ActiveCut& cut, const ActiveTriangles& part,
                            std::uint32_t triangle) {
  std::uint32_t widest = kNoSlot;
  float radius = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t slot = part.slots[3 * std::size_t(triangle) + k];
    const SplitId s = cut.vertices()[slot].split;
    if (s == kNoSplit) continue;
    const float wide = cut.hierarchy().vertices.bounds[index_of(s)].radius.value();
    if (wide > radius) {
      radius = wide;
      widest = slot;
    }
  }
  return widest;
}

}  // namespace

Folds find_folds(const ActiveCut& cut, std::span<const char> faces_away) {
  Folds folds;
  if (cut.normal_layer() == kNone) return folds;
  for (const ActiveTriangles& part : cut.parts()) {
    for (std::uint32_t t = 0; t < part.size(); ++t) {
      const TriangleId id = part.ids[t];
      if (id == kNoTriangle || (!faces_away.empty() && faces_away[index_of(id)] != 0)) continue;
      if (!is_fold(cut, part, t)) continue;
      ++folds.count;
      const std::uint32_t slot = widest_corner(cut, part, t);
      if (slot != kNoSlot) folds.slots.push_back(slot);
    }
  }
  std::sort(folds.slots.begin(), folds.slots.end());
  folds.slots.erase(std::unique(folds.slots.begin(), folds.slots.end()), folds.slots.end());
  return folds;
}

}  // namespace crease
