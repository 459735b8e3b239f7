#include "crease/progressive_arrays.h"

#include <algorithm>
#include <cstring>

namespace crease {

namespace {

constexpr std::size_t kPosition = 12, kNormal = 12, kIndex = 4;

// (vertex, normal) pairs at full resolution. A slot's own normal and an index to the same bits are
// one: see Sharing in the build.
std::size_t wedge_count(const ProgressiveArrays& arrays) {
  const SectionCounts& full = arrays.full;
  const std::size_t first_fn = full.sn_triangles;
  const std::size_t first_nsn = first_fn + full.fn_triangles;
  std::vector<std::uint64_t> wedges;  // slot, normal index
  wedges.reserve(3 * (full.triangles() - first_fn));
  for (std::size_t c = 3 * first_fn; c < 3 * full.triangles(); ++c) {
    const std::uint32_t slot = arrays.indices[c];
    std::uint32_t normal = c < 3 * first_nsn ? arrays.fn_normals[c / 3 - first_fn]
                                             : arrays.nsn_normals[c - 3 * first_nsn];
    if (slot < full.sn_vertices &&
        std::memcmp(&arrays.normals[slot], &arrays.normals[normal], sizeof(Vec3f)) == 0) {
      normal = slot;
    }
    wedges.push_back(std::uint64_t(slot) << 32 | normal);
  }
  for (std::uint32_t slot = 0; slot < full.sn_vertices; ++slot) {
    wedges.push_back(std::uint64_t(slot) << 32 | slot);
  }
  std::sort(wedges.begin(), wedges.end());
  return static_cast<std::size_t>(std::unique(wedges.begin(), wedges.end()) - wedges.begin());
}

// Normals that the full level shows; the others come up at coarser levels only.
std::size_t full_normal_count(const ProgressiveArrays& arrays) {
  std::vector<bool> shown(arrays.normals.size(), false);
  std::fill_n(shown.begin(), arrays.full.sn_vertices, true);
  for (const std::uint32_t normal : arrays.fn_normals) shown[normal] = true;
  for (const std::uint32_t normal : arrays.nsn_normals) shown[normal] = true;
  return static_cast<std::size_t>(std::count(shown.begin(), shown.end(), true));
}

template <typename T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

}  // namespace

LinearBytes linear_bytes(const ProgressiveArrays& arrays) {
  const SectionCounts& full = arrays.full;
  const std::size_t positions = kPosition * full.vertices();
  const std::size_t triangles = 3 * kIndex * full.triangles();
  const std::size_t wedges = wedge_count(arrays);
  const std::size_t normals = full_normal_count(arrays);
  const PackedContractions& p = arrays.contractions;

  LinearBytes bytes;
  bytes.crease = positions + triangles + kNormal * normals +
                 kIndex * (arrays.fn_normals.size() + arrays.nsn_normals.size());
  bytes.wedge = positions + triangles + (kIndex + kNormal) * wedges;
  bytes.replicated = triangles + (kPosition + kNormal) * wedges;
  bytes.records = bytes_of(p.kept) + bytes_of(p.headers) + bytes_of(p.deltas) + bytes_of(p.wide) +
                  bytes_of(p.corners) + bytes_of(p.own) + bytes_of(p.block_ends) +
                  bytes_of(p.blocks) + bytes_of(p.errors) +
                  kNormal * (arrays.normals.size() - normals);
  return bytes;
}

}  // namespace crease
