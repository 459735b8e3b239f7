#include "io/gltf_used_vertices.h"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

namespace crease {

namespace {

void keep_rows_of(GltfReader::Floats& floats, std::span<const std::uint32_t> rows) {
  const std::size_t n = floats.components;
  for (std::size_t to = 0; to < rows.size(); ++to) {  // none lies before its place
    std::copy_n(&floats.values[n * rows[to]], n, &floats.values[n * to]);
  }
  floats.values.resize(n * rows.size());
}

}  // namespace

std::vector<std::uint32_t> keep_used_vertices(const Json& attributes, std::size_t vertex_count,
                                              std::vector<std::uint32_t>& indices,
                                              GltfReader& reader) {
  if (indices.empty() || !attributes.is_object()) return {};
  std::vector<std::uint32_t> used = indices;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  if (used.size() > vertex_count / 2) return {};

  std::map<std::size_t, GltfReader::Floats> kept;  // attributes may share an accessor
  for (auto it = attributes.begin(); it != attributes.end(); ++it) {
    const auto accessor = as_index(it.value());
    const std::size_t components = reader.components_of(it.value());
    if (!accessor || components == 0) return {};
    if (kept.contains(*accessor)) continue;
    Result<GltfReader::Floats> floats = reader.floats(it.value(), components, components, it.key());
    if (!floats.ok() || floats->count() != vertex_count) return {};
    keep_rows_of(*floats, used);
    floats->is_worked_out = true;
    kept.emplace(*accessor, *std::move(floats));
  }
  for (auto& [accessor, floats] : kept) reader.give(accessor, std::move(floats));
  for (std::uint32_t& i : indices) {
    i = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), i) - used.begin());
  }
  return used;
}

}  // namespace crease
