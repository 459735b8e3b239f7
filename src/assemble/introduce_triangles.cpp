#include "assemble/introduce_triangles.h"

#include "assemble/merge_times.h"

#include <algorithm>
#include <numeric>

namespace crease {

TriangleTimes find_times(const Mesh& snapped, const ContractionSequence& sequence,
                         const std::vector<WedgeId>& wedge_of_corner, std::size_t wedge_count) {
  const MergeTimes merged(snapped.vertex_count(), sequence.contractions);
  const std::size_t triangle_count = snapped.triangle_count();
  TriangleTimes times;
  times.derived.assign(triangle_count, kNever);
  for (std::uint32_t i = 0; i < sequence.contractions.size(); ++i) {
    for (TriangleId t : sequence.derived_of(sequence.contractions[i])) {
      times.derived[index_of(t)] = i;
    }
  }
  times.collapsed.resize(triangle_count);
  times.wedge_live_until.assign(wedge_count, 0);
  times.normal_shown_until.assign(wedge_count, 0);
  times.wedge_shown_until.assign(wedge_count, 0);
  const auto extend = [](std::uint32_t& until, std::uint32_t time) {
    until = std::max(until, time);
  };
  for (std::size_t t = 0; t < triangle_count; ++t) {
    const Triangle& v = snapped.triangles[t];
    std::uint32_t with_next[3];  // when corner c becomes one with corner c + 1
    for (std::size_t c = 0; c < 3; ++c) with_next[c] = merged.of(v[c], v[(c + 1) % 3]);
    times.collapsed[t] = *std::min_element(with_next, with_next + 3);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t w = index_of(wedge_of_corner[3 * t + c]);
      extend(times.wedge_live_until[w], std::min(with_next[c], with_next[(c + 2) % 3]));
      extend(times.wedge_shown_until[w], times.collapsed[t]);
      extend(times.normal_shown_until[w], std::min(times.collapsed[t], times.derived[t]));
    }
  }
  return times;
}

namespace {

void add_derived(const VertexForest& forest, const TriangleTimes& times,
                 const std::vector<TriangleId>& old_of_new, VertexHierarchy& h) {
  std::vector<std::vector<TriangleId>> of_split(h.split_count());
  for (std::uint32_t n = 0; n < old_of_new.size(); ++n) {
    const std::uint32_t time = times.derived[index_of(old_of_new[n])];
    h.is_derived.push_back(time != kNever);
    if (time == kNever) continue;
    h.deriving_splits.push_back(forest.split_of_contraction[time]);
    of_split[index_of(h.deriving_splits.back())].push_back(TriangleId{n});
  }
  if (h.deriving_splits.empty()) h.is_derived = {};
  for (const std::vector<TriangleId>& list : of_split) h.derived_of_split.push_back(list);
}

}  // namespace

std::vector<TriangleId> arrange_triangles(const Mesh& snapped, const VertexForest& forest,
                                          const std::vector<WedgeId>& wedge_of_corner,
                                          const TriangleTimes& times, VertexHierarchy& hierarchy) {
  const std::size_t triangle_count = snapped.triangle_count();
  const auto group_of = [&](std::size_t t) {
    const std::uint32_t time = times.collapsed[t];
    return time == kNever ? 0 : index_of(forest.split_of_contraction[time]) + 1;
  };
  std::vector<std::uint32_t> first(hierarchy.split_count() + 2, 0);
  for (std::size_t t = 0; t < triangle_count; ++t) ++first[group_of(t) + 1];
  for (std::size_t g = 0; g + 1 < first.size(); ++g) {
    hierarchy.triangle_ranges.push_back(first[g + 1]);
  }
  std::partial_sum(first.begin(), first.end(), first.begin());

  std::vector<TriangleId> new_of_old(triangle_count), old_of_new(triangle_count);
  for (std::uint32_t t = 0; t < triangle_count; ++t) {
    new_of_old[t] = TriangleId{first[group_of(t)]++};
    old_of_new[index_of(new_of_old[t])] = TriangleId{t};
  }
  hierarchy.triangles.of_corner = PackedIndices<WedgeId>(bits_for(hierarchy.wedge_count()));
  hierarchy.material_of_triangle = PackedIndices<MaterialId>(bits_for(snapped.materials.size()));
  hierarchy.part_of_triangle = PackedIndices<PartId>(bits_for(snapped.parts.size()));
  for (TriangleId old : old_of_new) {
    const std::size_t t = index_of(old);
    for (std::size_t c = 0; c < 3; ++c) {
      hierarchy.triangles.of_corner.push_back(wedge_of_corner[3 * t + c]);
    }
    if (!snapped.material_of_triangle.empty()) {
      hierarchy.material_of_triangle.push_back(snapped.material_of_triangle[t]);
    }
    if (!snapped.part_of_triangle.empty()) {
      hierarchy.part_of_triangle.push_back(snapped.part_of_triangle[t]);
    }
  }
  add_derived(forest, times, old_of_new, hierarchy);
  return new_of_old;
}

}  // namespace crease
