// Where the children of a split are; included by block_coder.h.
#pragma once

#include "codec/block_coder.h"
#include "codec/mixed_bit.h"

#include <cmath>

namespace crease::codec {

// First whether a child stays where the parent was, then where the second goes, then the first.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_positions(std::uint32_t t, std::uint32_t u, const Vec3i& s) {
  Vec3i at_t{}, at_u{};
  if constexpr (Coder::kEncodes) {
    at_t = guide_.position(t, false);
    at_u = guide_.position(t, true);
  }
  const Surroundings around = surroundings_of_split(t, u, s);
  const StaysContext context = stays_context(around, around_[t].size(), around_[u].size());
  const bool t_stays = code_stays(0, context, at_t == s);
  const bool u_stays = code_stays(1 + t_stays, context, at_u == s);
  const bool both = !t_stays && !u_stays;
  if (!both || !code_between(t, u, at_t, at_u, around)) {
    if (u_stays) {
      at_u = s;
    } else {
      at_u = code_position(u, true, at_u, around, both ? Leaving::SecondOfBoth : Leaving::One,
                           child_ring(true, s, s), s);
    }
    if (t_stays) {
      at_t = s;
    } else {
      at_t = code_position(t, false, at_t, around, both ? Leaving::FirstOfBoth : Leaving::One,
                           child_ring(false, s, at_u), both ? at_u : s);
    }
  }
  mesh_.positions[u] = at_u;
  mesh_.positions[t] = at_t;
  has_moved_[u] = has_moved_[u] || !u_stays;
  has_moved_[t] = has_moved_[t] || !t_stays;
}

// In a fan the vertices' places are known already.
template <class Coder, class Guide>
Surroundings BlockCoder<Coder, Guide>::surroundings_of_split(std::uint32_t t, std::uint32_t u,
                                                             const Vec3i& s) {
  if (!is_one_of_fan_) return surroundings(mesh_, around_[t], around_[u], t, u, s);
  std::size_t count = ring_.vertices.size();
  if (is_closed_fan_) {  // goes round once more
    std::copy_n(places_.begin(), count, places_.begin() + static_cast<std::ptrdiff_t>(count));
    places_[2 * count] = places_[0];
    ++count;
  }
  return surroundings_in_fan(std::span(places_).first(count), fan_.first, fan_.last, fan_.single,
                             s);
}

template <class Coder, class Guide>
typename BlockCoder<Coder, Guide>::StaysContext BlockCoder<Coder, Guide>::stays_context(
    const Surroundings& around, std::size_t triangles_t, std::size_t triangles_u) {
  const float a = length(around.middle[0]), b = length(around.middle[1]);
  const std::size_t share =
      a + b > 0 ? std::min<std::size_t>(static_cast<std::size_t>(16 * a / (a + b)), 15) : 7;
  const std::size_t first = std::min<std::size_t>(triangles_t, 9),
                    second = std::min<std::size_t>(triangles_u, 9);
  return {share, first, second, first < second ? 0u : first == second ? 1u : 2u};
}

// Whether a child stays: mostly the one whose neighbours lie around the parent's place.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::code_stays(std::size_t question, const StaysContext& c, bool stays) {
  StaysModels& models = stays_[question];
  MixedBit<3> bit({&models.by_share[c.share], &models.by_triangles[c.first][c.second],
                   &models.by_both[c.share / 2][c.which_has_more]},
                  models.weights);
  return coder_.bit(bit, stays);
}

// As its neighbours' on average, or a quarter of their distance.
template <class Coder, class Guide>
Miss BlockCoder<Coder, Guide>::expected_miss(std::uint32_t v, const Surroundings& around) const {
  FourFloats sum{};
  const std::size_t triangles = std::min(around_[v].size(), kLargestRing);
  for (const std::uint32_t t : around_[v].first(triangles)) {
    for (const std::uint32_t w : mesh_.triangles[t]) sum += miss_[w];
  }
  const float start = around.mean_edge * 0.25f, count = sum[2] + 1;
  return {(sum[0] + start) / count, (sum[1] + 0.25f * start) / count};
}

// The neighbours of a child of the present split, if both have closed fans.
template <class Coder, class Guide>
ChildRing BlockCoder<Coder, Guide>::child_ring(bool second, const Vec3i& s,
                                               const Vec3i& sibling) const {
  ChildRing result;
  result.sibling = seen_from(s, sibling);
  if (!is_closed_fan_) return result;
  const std::size_t n = ring_.vertices.size();
  const std::size_t first = second ? fan_.first : fan_.last;
  const std::size_t last = second ? fan_.last : fan_.first + n;
  result.arc = std::span(places_).subspan(first, last + 1 - first);
  result.beyond = {places_[first + n - 1], places_[last + 1]};
  return result;
}

// Where the parent was, where the sibling is if that is known to be elsewhere, and the neighbours.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::see_neighbours(std::uint32_t v, const Surroundings& around,
                                              const Vec3i& sibling, SeenPlace& seen) const {
  seen.add({0, 0, 0});
  if (sibling != around.parent) seen.add(from_parent(around, sibling));
  for (const std::uint32_t t : around_[v].first(std::min(around_[v].size(), kMostSeen))) {
    const Corners& corners = mesh_.triangles[t];
    const std::uint32_t w = corners[kCornerAfter[corner_of(corners, v)]];
    seen.add(from_parent(around, mesh_.positions[w]));
  }
}

template <class Coder, class Guide>
Vec3i BlockCoder<Coder, Guide>::code_position(std::uint32_t v, bool second, const Vec3i& position,
                                              const Surroundings& around, Leaving leaving,
                                              const ChildRing& ring, const Vec3i& sibling) {
  PlaceModel& model = place_models_[std::size_t(leaving)];
  const std::size_t triangles = around_[v].size();
  const Sizes expected = sizes(around, expected_miss(v, around));
  PlaceMixture mixture = model.mixture(around, second, triangles, ring, expected);
  SeenPlace seen(seen_models_, seen_gate_, std::size_t(leaving));
  if (seen.looks()) see_neighbours(v, around, sibling, seen);
  const Step place = code_place(coder_, mixture, from_parent(around, position), seen);
  seen.finish();
  model.learn(mixture, triangles, expected);
  note_miss(v, mixture, place);
  return beside_parent(around, place);
}

// How far from where its neighbours had it v is.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::note_miss(std::uint32_t v, const PlaceMixture& mixture,
                                         const Step& place) {
  const auto off = [&](std::size_t i) {
    const float along = static_cast<float>(place[i]);
    const float plane =
        i < 2 ? 0
              : rise(mixture.direction, static_cast<float>(place[0]), static_cast<float>(place[1]));
    return std::abs(along - plane - mixture.center[i][0]);
  };
  miss_[v] = FourFloats{std::max(off(0), off(1)), off(2), 1, 0};
}

// Two children that both leave, of a parent that lies between them as between.h says: how, then the
// second child, then what that leaves open of the first. False: it does not.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::code_between(std::uint32_t t, std::uint32_t u, Vec3i& at_t,
                                            Vec3i& at_u, const Surroundings& around) {
  std::optional<Between> found;
  if constexpr (Coder::kEncodes) {
    found = find_between(from_parent(around, at_t), from_parent(around, at_u));
  }
  if (!coder_.bit(is_between_, found.has_value())) return false;
  Between between = found.value_or(Between{});
  between.eighths = code_eighths(coder_, eighths_, length(around.middle[0]),
                                 length(around.middle[1]), between.eighths);
  const auto steep = [&](std::size_t i) { return std::abs(around.normal[around.axis[i]]); };
  between.axis = code_step_axis(coder_, step_axes_, {steep(0), steep(1), steep(2)}, between.axis);
  ChildRing ring = child_ring(true, around.parent, around.parent);
  ring.share = static_cast<float>(between.eighths) / 8;
  at_u = code_position(u, true, at_u, around, Leaving::SecondBetween, ring, around.parent);
  at_t = code_other_end(t, at_t, at_u, around, between);
  return true;
}

// The first child, when the second one's place is known and how the parent lies between them.
template <class Coder, class Guide>
Vec3i BlockCoder<Coder, Guide>::code_other_end(std::uint32_t t, const Vec3i& at_t,
                                               const Vec3i& at_u, const Surroundings& around,
                                               const Between& between) {
  Step place = from_parent(around, at_t);
  const Step second = from_parent(around, at_u);
  const auto code_coordinate = [&](std::size_t i, std::int64_t above) {
    const EndRange range = other_ends(second[i], above, between.eighths);
    place[i] = static_cast<std::int32_t>(
        range.first +
        code_index(coder_, range.count, static_cast<std::uint32_t>(place[i] - range.first)));
  };
  const std::size_t axis = static_cast<std::size_t>(between.axis);
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  code_coordinate(i, 0);
  code_coordinate(j, 0);
  const std::int64_t step =
      between_step(std::int64_t(place[i]) - second[i], std::int64_t(place[j]) - second[j]);

  PlaceModel& model = place_models_[std::size_t(Leaving::FirstBetween)];
  const std::size_t triangles = around_[t].size();
  const Sizes expected = sizes(around, expected_miss(t, around));
  ChildRing ring = child_ring(false, around.parent, at_u);
  ring.share = static_cast<float>(8 - between.eighths) / 8;
  PlaceMixture mixture = model.mixture(around, false, triangles, ring, expected);
  const float eighths_a_step = 8 * static_cast<float>(step);
  const float offset =
      -(static_cast<float>(between.eighths) * static_cast<float>(second[axis]) + 0.5f) /
      eighths_a_step;
  const float per_unit = static_cast<float>(between.eighths - 8) / eighths_a_step;
  const std::int32_t steps =
      code_steps(coder_, mixture, axis, place, offset, per_unit, between.steps);
  code_coordinate(axis, -std::int64_t(steps) * step);
  model.learn(mixture, triangles, expected);
  note_miss(t, mixture, place);
  return beside_parent(around, place);
}

}  // namespace crease::codec
