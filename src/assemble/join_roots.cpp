#include "assemble/join_roots.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace crease {

namespace {

struct Root {
  std::uint64_t place;  // on the curve
  std::uint32_t slot;
  Vec3i position;
  LevelError error;
};

// The upper 21 bits of each coordinate, interleaved (Morton).
std::uint64_t place_of(const Vec3i& p) {
  std::uint64_t place = 0;
  for (int bit = 31; bit >= 11; --bit) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t shifted = static_cast<std::uint32_t>(p[i]) ^ 0x80000000u;
      place = place << 1 | (shifted >> bit & 1);
    }
  }
  return place;
}

// Of `a`, where b goes to: all that b stands for goes that way as well.
LevelError joined_error(const Root& a, const Root& b, double step) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = (double(a.position[i]) - double(b.position[i])) * step;
    square += d * d;
  }
  const auto away = static_cast<float>(std::sqrt(square));
  return {std::max(a.error.surface, away + b.error.surface), std::max(a.error.line, b.error.line),
          std::max(a.error.degrees, b.error.degrees), std::max(a.error.texture, b.error.texture)};
}

std::vector<Root> roots_of(const Mesh& snapped, const ContractionSequence& sequence) {
  std::vector<Root> slots;
  for (std::uint32_t v = 0; v < snapped.vertex_count(); ++v) {
    slots.push_back({0, v, sequence.grid.nearest(snapped.positions[v]), {}});
  }
  std::vector<bool> removed(slots.size(), false);
  for (const Contraction& c : sequence.contractions) {
    removed[index_of(c.removed)] = true;
    slots[index_of(c.kept)].position = c.position;
    slots[index_of(c.kept)].error = c.error;
  }
  std::erase_if(slots, [&](const Root& r) { return removed[r.slot]; });
  for (Root& r : slots) r.place = place_of(r.position);
  std::sort(slots.begin(), slots.end(), [](const Root& a, const Root& b) {
    return std::pair(a.place, a.slot) < std::pair(b.place, b.slot);
  });
  return slots;
}

}  // namespace

ContractionSequence join_roots(const Mesh& snapped, const ContractionSequence& sequence) {
  ContractionSequence joined = sequence;
  std::vector<Root> roots = roots_of(snapped, sequence);
  while (roots.size() > 1) {  // neighbours on the curve, pair by pair: a balanced tree
    std::vector<Root> next;
    for (std::size_t i = 0; i + 1 < roots.size(); i += 2) {
      Root root = roots[i];
      root.error = joined_error(roots[i], roots[i + 1], sequence.grid.step);
      Contraction c;
      c.removed = VertexId{roots[i + 1].slot};
      c.kept = VertexId{root.slot};
      c.position = root.position;
      c.error = root.error;
      c.first_change = static_cast<std::uint32_t>(joined.changes.size());
      c.first_derived = static_cast<std::uint32_t>(joined.derived.size());
      joined.contractions.push_back(c);
      next.push_back(root);
    }
    if (roots.size() % 2 != 0) next.push_back(roots.back());
    roots = std::move(next);
  }
  return joined;
}

}  // namespace crease
