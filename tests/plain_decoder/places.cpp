#include "plain_decoder/places.h"

#include "plain_decoder/tables.h"

#include <optional>

namespace plain {

// Surroundings.

Surroundings surroundings(const Surface& surface, std::uint32_t first, std::uint32_t second,
                          const Point& s) {
  Surroundings result;
  std::array<FloatVector, 2> normals, sizes;
  FloatVector thirds;
  float third_count = 0, all = 0;
  for (const std::size_t which : {0u, 1u}) {
    const std::uint32_t child = which == 0 ? first : second;
    const std::uint32_t other = which == 0 ? second : first;
    FloatVector sum;
    float count = 0;
    for (const std::uint32_t t : surface.list(child)) {
      const std::uint32_t after = surface.start_of(t, child), before = surface.end_of(t, child);
      const FloatVector a = step(surface.places[after], s);
      const FloatVector b = step(surface.places[before], s);
      if (after == other || before == other) {
        thirds = thirds + (after == other ? b : a);
        third_count += 1;
      } else {
        normals[which] = normals[which] + cross(a, b);
      }
      if (after != other) {
        sum = sum + a;
        count += 1;
        sizes[which] = sizes[which] + sizes_of(a);
      }
      if (before != other) {
        sum = sum + b;
        count += 1;
        sizes[which] = sizes[which] + sizes_of(b);
      }
    }
    all += count;
    if (count > 0) result.middle[which] = sum * (1 / count);
  }
  if (third_count > 0) result.thirds = thirds * (1 / third_count);
  result.edge = all > 0 ? length_1(sizes[0] + sizes[1]) / all : 0;
  const FloatVector N = normals[0] + normals[1];
  result.normal = unit(N);
  const float cosine = dot(unit(normals[0]), unit(normals[1]));
  result.bend = result.edge * std::sqrt(std::max(0.0f, 1 - cosine));
  std::size_t third = 0;
  for (const std::size_t k : {1u, 2u}) {
    if (std::abs(N.along(k)) > std::abs(N.along(third))) third = k;
  }
  result.axis = {(third + 1) % 3, (third + 2) % 3, third};
  return result;
}

// Positions: sizes.

Sizes sizes_of_place(const Surroundings& around, const Miss& expected) {
  return {log2_of(expected.tangent + 0.25f), log2_of(expected.normal + 0.25f),
          log2_of(around.edge + 1), log2_of(around.bend + 1)};
}

namespace {

using Direction = std::array<float, 3>;  // of the normal along the three axes

float rise(const Direction& D, float x, float y) {
  return -(D[0] * x + D[1] * y) / D[2];
}

// Positions: components. The place that each expects; none where it has no weight.
std::array<std::optional<FloatVector>, kComponents> expected_places(const Surroundings& around,
                                                                    const Child& child) {
  const std::array<float, 8>& k = kPlaces[std::size_t(child.who)].k;
  const FloatVector& own = around.middle[child.second ? 1 : 0];
  const FloatVector& other = around.middle[child.second ? 0 : 1];
  const FloatVector &normal = around.normal, &sibling = child.sibling;
  const float q = k[4] * dot(own, normal) + k[5] * dot(other, normal) +
                  k[6] * dot(around.thirds, normal) + k[7] * dot(sibling, normal);
  std::array<std::optional<FloatVector>, kComponents> places;
  places[0] = own * k[0] + other * k[1] + around.thirds * k[2] + sibling * k[3] + normal * q;
  const float rest = 1 - child.share;
  places[1] = own * 0.6f;
  if (child.who == Who::FirstOfBoth) places[1] = sibling * -1;
  if (child.who == Who::FirstBetween) places[1] = sibling * (-rest / child.share);
  std::vector<FloatVector> r = child.ring;
  if (child.who == Who::SecondBetween) {
    places[0] = *places[0] * rest;
    places[1] = own * (1.2f * rest);
    if (!r.empty()) r[0] = *places[0] * (-child.share / rest);
  }
  if (!r.empty()) {
    const std::size_t c = r.size(), h = c / 2;
    places[2] = (r[0] + r[h]) * 0.5f;
    places[3] = r[c - 1] + r[0] - child.after;
    places[4] = r[1] + r[0] - child.before;
    places[5] = (r[1] + r[(1 + h) % c]) * 0.5f;
    places[6] = (r[c - 1] + r[c - 1 - h]) * 0.5f;
  }
  places[7] = FloatVector{};
  return places;
}

}  // namespace

PlaceModel::PlaceModel(Who who, const Rates& rates) {
  const PlaceStart& start = kPlaces[std::size_t(who)];
  for (std::size_t c = 0; c < weights_.size(); ++c) weights_[c].of = start.weights[c];
  const PlaceScales& scales = kPlaceScales[start.scales];
  tangent_ = {scales.tangent, scales.tangent_slopes, rates.place_slopes, rates.first};
  normal_ = {scales.normal, scales.normal_slopes, rates.place_slopes, rates.first};
  mean_.rate = rates.mean;
}

std::size_t PlaceModel::weights_of(const Child& child) {
  return std::clamp<std::size_t>(child.triangles, 3, 8) - 3;
}

PlaceModel::Expected PlaceModel::expect(const Surroundings& around, const Child& child,
                                        const Sizes& sizes) const {
  const std::array<std::size_t, 3>& axis = around.axis;
  Expected result;
  if (around.normal.along(axis[2]) != 0) {
    for (std::size_t i = 0; i < 3; ++i) result.D[i] = around.normal.along(axis[i]);
  }
  result.weight = weights_[weights_of(child)].of;
  const auto places = expected_places(around, child);
  for (std::size_t k = 0; k < kComponents; ++k) {
    if (!places[k]) {
      result.weight[k] = 0;
      continue;
    }
    const float x = places[k]->along(axis[0]), y = places[k]->along(axis[1]);
    result.centre[0][k] = x;
    result.centre[1][k] = y;
    result.centre[2][k] = places[k]->along(axis[2]) - rise(result.D, x, y);
  }
  result.T = tangent_.at(sizes);
  result.N = normal_.at(sizes);
  if (child.who == Who::SecondBetween) {
    for (PerComponent* scales : {&result.T, &result.N}) {
      for (float& scale : *scales) scale *= 2 * (1 - child.share);
    }
  }
  return result;
}

void PlaceModel::learn(const Child& child, const Expected& expected, const Sizes& sizes) {
  PerComponent shares = expected.weight;
  if (!make_shares(shares)) return;
  weights_[weights_of(child)].learn(shares);
  mean_.learn(sizes);
  tangent_.learn(shares, expected.tangent_excess, sizes, mean_.of);
  normal_.learn(shares, expected.normal_excess, sizes, mean_.of);
}

Miss PlaceModel::miss_of(const Expected& expected, const Along& place) {
  const float x = std::abs(float(place[0]) - expected.centre[0][0]);
  const float y = std::abs(float(place[1]) - expected.centre[1][0]);
  const float above = float(place[2]) - rise(expected.D, float(place[0]), float(place[1]));
  return {std::max(x, y), std::abs(above - expected.centre[2][0])};
}

// Positions: coding.
Along PlaceModel::read(RangeDecoder& in, const Surroundings& around, const Child& child,
                       const Sizes& sizes, SeenPlace& seen, Miss& miss) {
  Expected expected = expect(around, child, sizes);
  const Direction& D = expected.D;
  Axis now;
  now.weight = expected.weight;
  Along place{};

  // 1.
  const float across = std::sqrt(std::max(1 - D[0] * D[0], 0.0f));
  PerComponent scale;
  for (std::size_t k = 0; k < kComponents; ++k) {
    scale[k] = expected.T[k] * across + 0.2f;
    now.centre[k] = expected.centre[0][k];
    now.inverse_scale[k] = 1 / scale[k];
  }
  place[0] = seen.read(in, 0, 0, now, scale[0]);

  // 2.
  const float along = D[0] * D[1] / (across * across), rest = std::abs(D[2]) / across;
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float off = float(place[0]) - now.centre[k], i = now.inverse_scale[k], z = off * i;
    expected.tangent_excess[k] = excess(z * z) * (1 - 0.2f * i);
    scale[k] = expected.T[k] * rest * std::sqrt(0.5f + 0.5f * z * z) + 0.2f;
    now.centre[k] = expected.centre[1][k] - along * off;
    now.inverse_scale[k] = 1 / scale[k];
  }
  place[1] = seen.read(in, 1, 0, now, scale[0]);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float i = now.inverse_scale[k], z = (float(place[1]) - now.centre[k]) * i;
    expected.tangent_excess[k] += excess(z * z) * (1 - 0.2f * i);
  }

  // 3.
  for (std::size_t k = 0; k < kComponents; ++k) {
    scale[k] = expected.N[k] * (1 / std::abs(D[2])) + 0.2f;
    now.centre[k] = expected.centre[2][k];
    now.inverse_scale[k] = 1 / scale[k];
  }
  const std::int32_t plane = round_of(rise(D, float(place[0]), float(place[1])));
  const std::int32_t above = seen.read(in, 2, plane, now, scale[0]);
  seen.finish();
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float i = now.inverse_scale[k], z = (float(above) - now.centre[k]) * i;
    expected.normal_excess[k] = excess(z * z) * (1 - 0.2f * i);
  }
  place[2] = sum_of(above, plane);

  expected.weight = now.weight;
  learn(child, expected, sizes);
  miss = miss_of(expected, place);
  return place;
}

// Positions: between.
std::int32_t PlaceModel::read_count(RangeDecoder& in, Expected& expected, const Steps& steps,
                                    const Along& place) {
  const std::size_t i = (steps.axis + 1) % 3, j = (steps.axis + 2) % 3;
  const Direction& D = expected.D;
  float along = D[steps.axis];
  if (std::abs(along) < 0.1f) along = along < 0 ? -0.1f : 0.1f;
  const float plane = -(D[i] * float(place[i]) + D[j] * float(place[j])) / along;
  Axis now;
  now.weight = expected.weight;
  PerComponent scale;
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float above = plane + expected.centre[2][k] * (D[2] / along);
    now.centre[k] = steps.offset + steps.gain * above;
    scale[k] = expected.N[k] * (std::abs(steps.gain) / std::abs(along)) + 0.2f;
    now.inverse_scale[k] = 1 / scale[k];
  }
  const std::int32_t count = read_axis(in, now, round_of(now.centre[0]), scale[0]);
  for (std::size_t k = 0; k < kComponents; ++k) {
    const float inverse = now.inverse_scale[k], z = (float(count) - now.centre[k]) * inverse;
    expected.tangent_excess[k] = 0;
    expected.normal_excess[k] = excess(z * z) * (1 - 0.2f * inverse);
  }
  expected.weight = now.weight;
  return count;
}

}  // namespace plain
