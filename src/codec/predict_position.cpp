#include "codec/predict_position.h"

#include "crease/ids.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

// What the triangles of one child add up to.
struct ChildSums {
  Spot places{}, sizes{};
  Spot normal{};  // twice their areas, before a turn
  std::uint32_t count = 0;

  void add_triangle(const Spot& after, const Spot& before) {
    normal += cross_before_turn(after, before);
    places += after;
    places += before;
    sizes += size_of_each(after);
    sizes += size_of_each(before);
    count += 2;
  }
  void add_third(const Spot& third) {
    places += third;
    sizes += size_of_each(third);
    ++count;
  }
  Spot middle() const { return count > 0 ? places * (1 / static_cast<float>(count)) : Spot{}; }
};

Surroundings surroundings_of(const ChildSums& t, const ChildSums& u, const Spot& thirds,
                             std::uint32_t third_count, const Vec3i& parent) {
  Surroundings result;
  result.parent = parent;
  result.middle = {t.middle(), u.middle()};
  if (third_count > 0) result.thirds = thirds * (1 / static_cast<float>(third_count));
  const Spot normal = turned(t.normal + u.normal);
  result.normal = normalized(normal);
  const float size = sum_of_three(t.sizes + u.sizes);
  const std::uint32_t count = t.count + u.count;
  result.mean_edge = count > 0 ? size / static_cast<float>(count) : 0;
  const float cosine = dot(normalized(turned(t.normal)), normalized(turned(u.normal)));
  result.bend = result.mean_edge * std::sqrt(std::max(0.0f, 1 - cosine));

  const Spot along = size_of_each(normal);
  int main = along[1] > along[0] ? 1 : 0;
  if (along[2] > along[main]) main = 2;
  result.axis = {main < 2 ? main + 1 : 0, main > 0 ? main - 1 : 2, main};
  return result;
}

// From the parent's place.
struct Neighbour {
  std::uint32_t vertex = kNone;
  Spot place{};
};

}  // namespace

Surroundings surroundings(const PatchMesh& mesh, std::span<const std::uint32_t> around_t,
                          std::span<const std::uint32_t> around_u, std::uint32_t t, std::uint32_t u,
                          const Vec3i& parent) {
  std::array<ChildSums, 2> sums;
  Spot thirds{};
  std::uint32_t third_count = 0;
  const auto seen = [&](std::uint32_t w) {
    return Neighbour{w, seen_from(parent, mesh.positions[w])};
  };
  for (const bool second : {false, true}) {
    const std::uint32_t own = second ? u : t, other = second ? t : u;
    Neighbour a, b;
    for (const std::uint32_t triangle : second ? around_u : around_t) {
      const Corners& corners = mesh.triangles[triangle];
      const std::size_t c = corner_of(corners, own);
      const std::uint32_t after = corners[kCornerAfter[c]], before = corners[kCornerBefore[c]];
      a = b;  // mostly they follow each other
      if (after != b.vertex) a = seen(after);
      b = seen(before);
      if (after != other && before != other) {
        sums[second].add_triangle(a.place, b.place);
        continue;
      }
      const Spot& third = after == other ? b.place : a.place;
      thirds += third;
      ++third_count;
      sums[second].add_third(third);
    }
  }
  return surroundings_of(sums[0], sums[1], thirds, third_count, parent);
}

Surroundings surroundings_in_fan(std::span<const Spot> places, std::size_t first, std::size_t last,
                                 bool single, const Vec3i& parent) {
  ChildSums t, u;
  const Spot &at_first = places[first], &at_last = places[last];
  for (std::size_t k = 0; k < first; ++k) t.add_triangle(places[k], places[k + 1]);
  if (!single) t.add_third(at_first);
  t.add_third(at_last);
  for (std::size_t k = last; k + 1 < places.size(); ++k) t.add_triangle(places[k], places[k + 1]);
  for (std::size_t k = first; k < last; ++k) u.add_triangle(places[k], places[k + 1]);
  u.add_third(at_last);
  if (!single) u.add_third(at_first);
  if (single) return surroundings_of(t, u, at_last + at_last, 2, parent);
  return surroundings_of(t, u, at_first + at_last + at_last + at_first, 4, parent);
}

}  // namespace crease::codec
