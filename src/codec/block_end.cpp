#include "codec/block_end.h"

#include <algorithm>
#include <bit>
#include <cstddef>

namespace crease::codec {

namespace {

// The numbers of vertices by their names, for one coarse end after the other.
class NumberOfName {
 public:
  // Forgets all; of so many names at most.
  void start(std::size_t most) {
    const std::size_t size = std::bit_ceil(most + most / 2 + 1);
    if (size > places_.size()) places_.assign(size, {});
    mask_ = size - 1;
    ++start_;
  }
  // Of a name that is new it becomes `next`.
  std::uint32_t of(const VertexName& name, std::uint32_t next) {
    const std::uint64_t key = std::uint64_t(name.block) << 32 | name.vertex;
    const std::uint64_t mixed = (key ^ key >> 29) * 0x9e3779b97f4a7c15u;
    std::size_t at = (mixed >> 32) & mask_;
    while (places_[at].start == start_ && !(places_[at].name == name)) at = (at + 1) & mask_;
    if (places_[at].start != start_) places_[at] = {name, next, start_};
    return places_[at].number;
  }

 private:
  struct Place {
    VertexName name;
    std::uint32_t number = 0, start = 0;
  };
  std::vector<Place> places_;
  std::size_t mask_ = 0;
  std::uint32_t start_ = 0;
};

// Makes the mesh of start.sources.
class CoarseEndMaker {
 public:
  explicit CoarseEndMaker(std::span<const FineEnd* const> ends) : ends_(ends) {
    std::size_t count = 0;
    for (const FineEnd* end : ends) {
      first_.push_back(count);
      count += end->names.size();
    }
    local_.resize(count);
  }

  void fill(CoarseEnd& start) {
    ++start_;
    by_name_.start(3 * start.sources.size());
    PatchMesh& mesh = start.mesh;
    reserve(start);
    for (const TriangleSource& source : start.sources) {
      const FineEnd& end = *ends_[source.end];
      Corners corners = end.mesh.triangles[source.triangle];
      for (std::uint32_t& v : corners) v = local_of(source.end, v, start);
      mesh.triangles.push_back(corners);
      mesh.category.push_back(end.mesh.category[source.triangle]);
      mesh.derived.push_back(end.mesh.derived[source.triangle]);
    }
    if (!ends_.empty()) mesh.values.resize(ends_[0]->mesh.values.size());
    for (std::size_t l = 0; l < mesh.values.size(); ++l) {
      mesh.values[l].resize(3 * start.sources.size());
      auto to = mesh.values[l].begin();
      for (const TriangleSource& source : start.sources) {
        const auto from =
            ends_[source.end]->mesh.values[l].begin() + 3 * std::ptrdiff_t(source.triangle);
        to = std::copy_n(from, 3, to);
      }
    }
  }

 private:
  struct Local {
    std::uint32_t number = 0, start = 0;
  };

  static void reserve(CoarseEnd& start) {
    start.mesh.triangles.reserve(start.sources.size());
    start.mesh.category.reserve(start.sources.size());
    start.mesh.derived.reserve(start.sources.size());
  }

  // A vertex may be at several ends, so its name tells; but mostly it was met at this one before.
  std::uint32_t local_of(std::uint32_t e, std::uint32_t v, CoarseEnd& start) {
    Local& local = local_[first_[e] + v];
    if (local.start == start_) return local.number;
    const FineEnd& end = *ends_[e];
    const auto next = static_cast<std::uint32_t>(start.names.size());
    local = {by_name_.of(end.names[v], next), start_};
    if (local.number == next) {
      start.mesh.positions.push_back(end.mesh.positions[v]);
      start.names.push_back(end.names[v]);
    }
    return local.number;
  }

  std::span<const FineEnd* const> ends_;
  std::vector<std::size_t> first_;  // per end: of its vertices in local_
  std::vector<Local> local_;        // per vertex of each end
  NumberOfName by_name_;
  std::uint32_t start_ = 0;  // counts them
};

}  // namespace

std::vector<CoarseEnd> sort_by_label(std::span<const FineEnd* const> ends,
                                     std::uint32_t patch_count) {
  std::vector<CoarseEnd> starts(patch_count);
  for (std::uint32_t e = 0; e < ends.size(); ++e) {
    const std::vector<std::uint32_t>& labels = ends[e]->labels;
    for (std::uint32_t t = 0; t < labels.size(); ++t) {
      if (labels[t] < patch_count) starts[labels[t]].sources.push_back({e, t});
    }
  }
  CoarseEndMaker maker(ends);
  for (CoarseEnd& start : starts) maker.fill(start);
  return starts;
}

std::vector<CoarseEnd> sort_by_label(std::span<const FineEnd> ends, std::uint32_t patch_count) {
  std::vector<const FineEnd*> pointers;
  for (const FineEnd& end : ends) pointers.push_back(&end);
  return sort_by_label(pointers, patch_count);
}

CoarseEnd coarse_end_of(std::span<const FineEnd* const> ends, std::uint32_t label) {
  CoarseEnd start;
  for (std::uint32_t e = 0; e < ends.size(); ++e) {
    for (std::uint32_t t = 0; t < ends[e]->labels.size(); ++t) {
      if (ends[e]->labels[t] == label) start.sources.push_back({e, t});
    }
  }
  CoarseEndMaker(ends).fill(start);
  return start;
}

}  // namespace crease::codec
