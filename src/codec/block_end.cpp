#include "codec/block_end.h"

#include "crease/ids.h"

#include <unordered_map>

namespace crease::codec {

namespace {

struct HashName {
  std::size_t operator()(const VertexName& name) const {
    return std::size_t((std::uint64_t(name.block) << 32 | name.vertex) * 0x9e3779b97f4a7c15u);
  }
};

// Makes the mesh of start.sources.
class CoarseEndMaker {
 public:
  explicit CoarseEndMaker(std::span<const FineEnd* const> ends) : ends_(ends) {}

  void fill(CoarseEnd& start) {
    local_.clear();
    PatchMesh& mesh = start.mesh;
    if (!ends_.empty()) mesh.values.resize(ends_[0]->mesh.values.size());
    for (const TriangleSource& source : start.sources) {
      const FineEnd& end = *ends_[source.end];
      Corners corners = end.mesh.triangles[source.triangle];
      for (std::uint32_t& v : corners) {
        const auto [at, is_new] =
            local_.try_emplace(end.names[v], static_cast<std::uint32_t>(mesh.positions.size()));
        if (is_new) {
          mesh.positions.push_back(end.mesh.positions[v]);
          start.names.push_back(end.names[v]);
        }
        v = at->second;
      }
      mesh.triangles.push_back(corners);
      mesh.category.push_back(end.mesh.category[source.triangle]);
      mesh.derived.push_back(end.mesh.derived[source.triangle]);
      for (std::size_t l = 0; l < mesh.values.size(); ++l) {
        const auto first = end.mesh.values[l].begin() + 3 * std::ptrdiff_t(source.triangle);
        mesh.values[l].insert(mesh.values[l].end(), first, first + 3);
      }
    }
  }

 private:
  std::span<const FineEnd* const> ends_;
  std::unordered_map<VertexName, std::uint32_t, HashName> local_;
};

}  // namespace

std::vector<CoarseEnd> sort_by_label(std::span<const FineEnd> ends, std::uint32_t patch_count) {
  std::vector<CoarseEnd> starts(patch_count);
  std::vector<const FineEnd*> pointers;
  for (std::uint32_t e = 0; e < ends.size(); ++e) {
    pointers.push_back(&ends[e]);
    for (std::uint32_t t = 0; t < ends[e].labels.size(); ++t) {
      if (ends[e].labels[t] < patch_count) starts[ends[e].labels[t]].sources.push_back({e, t});
    }
  }
  CoarseEndMaker maker(pointers);
  for (CoarseEnd& start : starts) maker.fill(start);
  return starts;
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
