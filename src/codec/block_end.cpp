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

}  // namespace

std::vector<CoarseEnd> sort_by_label(std::span<const FineEnd> ends, std::uint32_t patch_count) {
  std::vector<CoarseEnd> starts(patch_count);
  for (std::uint32_t e = 0; e < ends.size(); ++e) {
    for (std::uint32_t t = 0; t < ends[e].labels.size(); ++t) {
      if (ends[e].labels[t] < patch_count) starts[ends[e].labels[t]].sources.push_back({e, t});
    }
  }
  std::unordered_map<VertexName, std::uint32_t, HashName> local;
  for (CoarseEnd& start : starts) {
    local.clear();
    PatchMesh& mesh = start.mesh;
    if (!ends.empty()) mesh.values.resize(ends[0].mesh.values.size());
    for (const TriangleSource& source : start.sources) {
      const FineEnd& end = ends[source.end];
      Corners corners = end.mesh.triangles[source.triangle];
      for (std::uint32_t& v : corners) {
        const auto [at, is_new] =
            local.try_emplace(end.names[v], static_cast<std::uint32_t>(mesh.positions.size()));
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
  return starts;
}

}  // namespace crease::codec
