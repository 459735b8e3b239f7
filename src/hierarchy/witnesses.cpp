#include "hierarchy/witnesses.h"

namespace crease {

Witnesses witnesses_of(const Mesh& mesh, std::span<const Vec3i> positions) {
  Witnesses witnesses;
  witnesses.all.reserve(positions.size());
  for (const Vec3i& place : positions) witnesses.all.push_back({place});
  witnesses.first.assign(mesh.triangle_count(), kNone);
  std::vector<char> is_put(positions.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (const VertexId v : mesh.triangles[t]) {
      char& is = is_put[index_of(v)];
      if (is == 0) witnesses.put(static_cast<std::uint32_t>(index_of(v)), t);
      is = 1;
    }
  }
  return witnesses;
}

WitnessesOfPart::WitnessesOfPart(const Witnesses& model, std::span<const std::uint32_t> triangles) {
  here_.first.assign(triangles.size(), kNone);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t w = model.first[triangles[t]]; w != kNone; w = model.all[w].next) {
      here_.all.push_back(model.all[w]);
      here_.put(static_cast<std::uint32_t>(ids_.size()), t);
      ids_.push_back(w);
    }
  }
}

void WitnessesOfPart::give_back(std::span<const std::uint32_t> triangles, std::size_t count,
                                Witnesses& model) const {
  for (const std::uint32_t t : triangles) model.first[t] = kNone;
  for (std::size_t t = 0; t < count; ++t) {
    for (std::uint32_t w = here_.first[t]; w != kNone; w = here_.all[w].next) {
      model.all[ids_[w]] = here_.all[w];
      model.put(ids_[w], triangles[t]);
    }
  }
}

}  // namespace crease
