#include "codec/face_normals.h"

#include "hierarchy/geometric_normal.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

Vec3d real(const Vec3f& v) {
  return {double(v.x), double(v.y), double(v.z)};
}

Vec3d geometric(const Corners& t, std::span<const Vec3i> positions) {
  return real(geometric_normal(positions[t[0]], positions[t[1]], positions[t[2]]));
}

double area_of(const Corners& t, std::span<const Vec3i> positions) {
  const auto side = [&](std::uint32_t v) {
    const Vec3i &from = positions[t[0]], &to = positions[v];
    return Vec3d{double(to.x) - double(from.x), double(to.y) - double(from.y),
                 double(to.z) - double(from.z)};
  };
  return 0.5 * length(cross(side(t[1]), side(t[2])));
}

}  // namespace

FaceNormals::FaceNormals(const UnfoldedBlock& block, const BlockCoding& coding,
                         std::span<const LayerValues> values, std::span<const char> is_face)
    : block_(block), is_face_(is_face) {
  std::size_t normals = 0;
  while (normals < coding.layers.size() && !coding.layers[normals].is_normal) ++normals;
  if (normals == coding.layers.size()) return;
  const PatchMesh& end = block.end;
  faces_.resize(end.triangles.size());
  for (std::size_t t = 0; t < faces_.size(); ++t) {
    if (!is_face[t]) continue;
    Face& face = faces_[t];
    face.is_derived = end.derived[t] != 0;
    if (face.is_derived) {
      face.shown = geometric(end.triangles[t], end.positions);
    } else {
      float n[3] = {};
      values[normals].read(end.values[normals][3 * t], n);
      face.shown = {double(n[0]), double(n[1]), double(n[2])};
    }
    face.area = area_of(end.triangles[t], end.positions);
    face.sum = face.shown * face.area;
  }
}

FaceNormals::Face* FaceNormals::heir_of(const ContractingPatch& patch, std::uint32_t vanished,
                                        std::uint32_t first) {
  const Corners& gone = patch.corners(vanished);
  Face* best = nullptr;
  for (const std::uint32_t t : patch.around(first)) {
    const auto is_shared = [&](std::uint32_t v) {
      return v != first && std::find(gone.begin(), gone.end(), v) != gone.end();
    };
    const Corners& corners = patch.corners(t);
    if (!is_face_[t] || !std::any_of(corners.begin(), corners.end(), is_shared)) continue;
    const Vec3d& sum = faces_[vanished].sum;
    if (best == nullptr || dot(faces_[t].shown, sum) > dot(best->shown, sum)) best = &faces_[t];
  }
  return best;
}

void FaceNormals::show(const ContractingPatch& patch, std::uint32_t t,
                       std::span<const Vec3i> positions) {
  Face& face = faces_[t];
  face.is_derived =
      face.is_derived || (t < block_.coarse_triangle_count() && block_.coarse_derived[t] != 0);
  if (face.is_derived) face.shown = geometric(patch.corners(t), positions);
}

float FaceNormals::contract(const ContractingPatch& patch, std::span<const std::uint32_t> vanished,
                            std::uint32_t first, std::span<const Vec3i> positions) {
  if (faces_.empty()) return 0;
  for (const std::uint32_t t : vanished) {
    Face* const heir = is_face_[t] ? heir_of(patch, t, first) : nullptr;
    if (heir == nullptr) continue;
    heir->sum += faces_[t].sum;
    heir->area += faces_[t].area;
  }
  double worst = 0;  // squared chord
  for (const std::uint32_t t : patch.around(first)) {
    if (!is_face_[t]) continue;
    show(patch, t, positions);
    const Face& face = faces_[t];
    if (!(face.area > 0) || face.shown == Vec3d{}) continue;
    worst = std::max(worst, 2 * (face.area - dot(face.sum, face.shown)) / face.area);
  }
  return static_cast<float>(degrees(2 * std::asin(std::min(1.0, 0.5 * std::sqrt(worst)))));
}

}  // namespace crease::codec
