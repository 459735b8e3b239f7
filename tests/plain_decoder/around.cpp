#include "plain_decoder/around.h"

#include <map>
#include <set>

namespace plain {

std::uint32_t Surface::add_vertex(const Point& place) {
  places.push_back(place);
  triangles_around.emplace_back();
  return static_cast<std::uint32_t>(places.size() - 1);
}

std::uint32_t Surface::add_triangle(const Triangle& corners) {
  const auto t = static_cast<std::uint32_t>(triangles.size());
  triangles.push_back(corners);
  for (const std::uint32_t v : corners) triangles_around[v].push_back(t);
  return t;
}

Numbers Surface::first_of_list(std::uint32_t v) const {
  Numbers result = list(v);
  if (result.size() > kLongest) result.resize(kLongest);
  return result;
}

std::uint32_t Surface::start_of(std::uint32_t t, std::uint32_t v) const {
  const Triangle& c = triangles[t];
  return c[0] == v ? c[1] : c[1] == v ? c[2] : c[0];
}

std::uint32_t Surface::end_of(std::uint32_t t, std::uint32_t v) const {
  const Triangle& c = triangles[t];
  return c[0] == v ? c[2] : c[1] == v ? c[0] : c[1];
}

bool Surface::has_corner(std::uint32_t t, std::uint32_t v) const {
  const Triangle& c = triangles[t];
  return c[0] == v || c[1] == v || c[2] == v;
}

std::optional<Fan> Surface::fan(std::uint32_t v) const {
  const Numbers& all = list(v);
  if (all.empty() || all.size() > kLongest) return std::nullopt;
  std::map<std::uint32_t, std::uint32_t> starting_at;  // per vertex
  std::set<std::uint32_t> ends;
  for (const std::uint32_t t : all) {
    starting_at[start_of(t, v)] = t;
    ends.insert(end_of(t, v));
  }
  if (starting_at.size() < all.size()) return std::nullopt;  // two start at the same vertex
  std::uint32_t first = all.front();
  bool closed = true;
  for (const auto& [start, t] : starting_at) {
    if (ends.contains(start)) continue;
    closed = false;
    first = t;
  }
  // From the first one on, each time the one that starts where this one ends.
  Fan fan{.triangles = {}, .w = {}, .closed = closed};
  std::uint32_t end = kNone;
  for (std::uint32_t t = first; fan.triangles.size() < all.size(); t = starting_at.at(end)) {
    fan.triangles.push_back(t);
    fan.w.push_back(start_of(t, v));
    end = end_of(t, v);
    if (!starting_at.contains(end) || starting_at.at(end) == first) break;
  }
  if (fan.triangles.size() < all.size()) return std::nullopt;  // several fans
  if (!closed && starting_at.contains(end)) return std::nullopt;
  if (!closed) fan.w.push_back(end);
  return fan;
}

FloatVector Surface::twice_area(std::uint32_t t) const {
  const Point &p = places[triangles[t][0]], &q = places[triangles[t][1]],
              &r = places[triangles[t][2]];
  return cross(step(q, p), step(r, p));
}

std::size_t Surface::bend(std::uint32_t t, std::uint32_t other) const {
  const FloatVector a = twice_area(t), b = twice_area(other);
  if (a.is_zero() || b.is_zero()) return 0;
  const float c = dot(unit(a), unit(b));
  return c >= 0.99995f ? 0 : c >= 0.97468f ? 1 : c >= 0.70711f ? 2 : 3;
}

Numbers Surface::neighbours_before(std::uint32_t t) const {
  Numbers result;
  for (std::size_t edge = 0; edge < 3; ++edge) {
    const std::uint32_t from = triangles[t][edge], to = triangles[t][(edge + 1) % 3];
    for (const std::uint32_t other : first_of_list(from)) {
      if (other < t && has_corner(other, to)) {
        result.push_back(other);
        break;
      }
    }
  }
  return result;
}

}  // namespace plain
