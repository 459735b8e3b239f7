#include "hierarchy/witnesses.h"

#include <array>

namespace crease {

namespace {

// a * b == c * d, exactly, of differences of coordinates: what is the same modulo 2^64 and but for
// the rounding of doubles is the same.
bool are_equal(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  const auto product = [](std::int64_t x, std::int64_t y) {
    return static_cast<std::uint64_t>(x) * static_cast<std::uint64_t>(y);
  };
  return product(a, b) == product(c, d) && static_cast<double>(a) * static_cast<double>(b) ==
                                               static_cast<double>(c) * static_cast<double>(d);
}

bool has_area(const Triangle& t, std::span<const Vec3i> positions) {
  const Vec3i& first = positions[index_of(t[0])];
  const auto from_first = [&](std::size_t i) {
    const Vec3i& p = positions[index_of(t[i])];
    return std::array<std::int64_t, 3>{std::int64_t(p.x) - first.x, std::int64_t(p.y) - first.y,
                                       std::int64_t(p.z) - first.z};
  };
  const auto u = from_first(1), v = from_first(2);
  return !are_equal(u[1], v[2], u[2], v[1]) || !are_equal(u[2], v[0], u[0], v[2]) ||
         !are_equal(u[0], v[1], u[1], v[0]);
}

}  // namespace

Witnesses witnesses_of(const Mesh& mesh, std::span<const Vec3i> positions) {
  Witnesses witnesses;
  witnesses.all.reserve(positions.size());
  for (const Vec3i& place : positions) witnesses.all.push_back({place});
  witnesses.first.assign(mesh.triangle_count(), kNone);
  std::vector<char> is_put(positions.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (!has_area(mesh.triangles[t], positions)) continue;
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
