// What triangles and corners have at a block's fine end; included by block_coder.h.
#pragma once

#include "codec/block_coder.h"
#include "codec/deterministic_math.h"

#include <cmath>

namespace crease::codec {

// Over each edge of t a triangle with a smaller number, or kNone. Only so many triangles at a
// vertex are looked at: more would take square time.
template <class Coder, class Guide>
std::array<std::uint32_t, 3> BlockCoder<Coder, Guide>::neighbours_before(std::uint32_t t) const {
  std::array<std::uint32_t, 3> result{kNone, kNone, kNone};
  const Corners& corners = mesh_.triangles[t];
  for (std::size_t c = 0; c < 3; ++c) {
    const std::uint32_t v = corners[c], w = corners[(c + 1) % 3];
    const std::size_t count = std::min(around_[v].size(), kLargestRing);
    for (const std::uint32_t other : around_[v].first(count)) {
      if (other >= t) continue;
      const Corners& o = mesh_.triangles[other];
      if (o[0] == w || o[1] == w || o[2] == w) {
        result[c] = other;
        break;
      }
    }
  }
  return result;
}

// A triangle's normal, twice its area long.
template <class Coder, class Guide>
Spot BlockCoder<Coder, Guide>::twice_area(std::uint32_t t) const {
  const Corners& corners = mesh_.triangles[t];
  const Vec3i& from = mesh_.positions[corners[0]];
  return turned(cross_before_turn(seen_from(from, mesh_.positions[corners[1]]),
                                  seen_from(from, mesh_.positions[corners[2]])));
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::find_areas() {
  areas_.resize(mesh_.triangles.size());
  for (std::uint32_t t = 0; t < areas_.size(); ++t) {
    const Spot twice = twice_area(t);
    areas_[t] = {twice, normalized(twice)};
    areas_[t].unit[3] = is_zero(twice) ? 0.0f : 1.0f;
  }
}

// By how much two triangles are turned against each other: not, a little, much, very much.
template <class Coder, class Guide>
std::size_t BlockCoder<Coder, Guide>::bend(std::uint32_t t, std::uint32_t other) const {
  constexpr FourFloats kCosines{0.99995f, 0.97468f, 0.70711f, -2};
  const Spot products = areas_[t].unit * areas_[other].unit;
  const float cosine = sum_of_three(products) + (2 - 2 * products[3]);  // 2 where one has none
  const FourInts below = FourFloats{} + cosine < kCosines;
  return static_cast<std::size_t>(-(below[0] + below[1] + below[2]));
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_categories() {
  mesh_.category.resize(mesh_.triangles.size(), 0);
  const std::uint32_t materials = coding_.material_count, parts = coding_.part_count;
  if (materials < 2 && parts < 2) return;
  std::uint32_t last = 0;
  for (std::uint32_t t = coarse_triangles_; t < mesh_.triangles.size(); ++t) {
    std::uint32_t category = 0;
    if constexpr (Coder::kEncodes) category = guide_.category(t);
    const std::array<std::uint32_t, 3> beside = neighbours_before(t);
    const std::uint32_t nearest = *std::min_element(beside.begin(), beside.end());
    const std::uint32_t expected = nearest == kNone ? last : mesh_.category[nearest];
    std::uint32_t part = category / materials, material = category % materials;
    if (coder_.bit(same_part_[nearest == kNone], part == expected / materials)) {
      part = expected / materials;
    } else {
      part = code_below(parts, part);
    }
    // What the neighbours are, as far as one word goes.
    const std::uint32_t expected_material = expected % materials;
    std::size_t agreeing = 0, known = 0;
    for (const std::uint32_t other : beside) {
      if (other == kNone) continue;
      ++known;
      agreeing += mesh_.category[other] % materials == expected_material;
    }
    if (coder_.bit(same_material_[std::min<std::size_t>(expected_material, 7)]
                                 [agreeing < known ? 3 : std::min<std::size_t>(known, 2)],
                   material == expected_material)) {
      material = expected_material;
    } else if (materials <= 64) {
      material = code_tree(coder_, other_material_, material);
      if (material >= materials) {
        corrupt_ = true;
        material = 0;
      }
    } else {
      material = code_below(materials, material);
    }
    mesh_.category[t] = last = part * materials + material;
  }
}

// Once a triangle shows its stored normal it does so at all finer ends.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_derived() {
  mesh_.derived.assign(mesh_.triangles.size(), 0);
  bool any = false;
  if constexpr (Coder::kEncodes) {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) any = any || guide_.derived(t);
  }
  if (!coder_.bit(any_derived_, any)) return;
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!is_new(t) && !was_derived_[t]) continue;
    bool derived = false;
    if constexpr (Coder::kEncodes) derived = guide_.derived(t);
    mesh_.derived[t] = coder_.bit(is_derived_[is_new(t)], derived);
  }
}

// The box that is nearest, of equal ones the oldest, or null; `distance` 0: the place is in it.
template <class Coder, class Guide>
typename BlockCoder<Coder, Guide>::LabelBox* BlockCoder<Coder, Guide>::nearest_box(
    const std::array<double, 3>& place, double& distance) {
  LabelBox* nearest = nullptr;
  for (LabelBox& box : boxes_) {
    const auto off = [&](std::size_t k) {
      return std::max(std::max(0.0, box.low[k] - place[k]), place[k] - box.high[k]);
    };
    const double away = off(0) + off(1) + off(2);
    if (nearest && away >= distance) continue;
    nearest = &box;
    distance = away;
    if (away == 0) break;
  }
  return nearest;
}

// The patch of the next finer band that each triangle is in: where the triangles around it are.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_labels() {
  labels_.assign(mesh_.triangles.size(), 0);
  bool any = false;
  if constexpr (Coder::kEncodes) {
    for (std::uint32_t t = 0; t < labels_.size(); ++t) any = any || guide_.label(t) != 0;
  }
  if (!coder_.bit(any_label_, any)) return;
  boxes_.clear();
  std::vector<std::uint32_t> last_at(mesh_.positions.size(), kNone);  // per vertex: what came there
  for (std::uint32_t t = 0; t < labels_.size(); ++t) {
    const Corners& corners = mesh_.triangles[t];
    const Vec3i &p = mesh_.positions[corners[0]], &q = mesh_.positions[corners[1]],
                &r = mesh_.positions[corners[2]];
    const std::array<double, 3> place{double(p.x) + q.x + r.x, double(p.y) + q.y + r.y,
                                      double(p.z) + q.z + r.z};
    double distance = 0;
    LabelBox* box = nearest_box(place, distance);
    std::uint32_t label = 0;
    if constexpr (Coder::kEncodes) label = guide_.label(t);
    bool same = false;
    std::uint32_t beside_label = kNone;
    if (box) {
      std::size_t agreement = 0;  // nothing at the corners, what agrees, what does not
      for (const std::uint32_t v : corners) {
        const std::uint32_t beside = last_at[v];
        if (beside == kNone) continue;
        if (beside != box->label) beside_label = beside;
        agreement = std::max<std::size_t>(agreement, beside == box->label ? 1 : 2);
      }
      same = coder_.bit(same_label_[distance > 0][agreement], label == box->label);
      if (same) label = box->label;
    }
    if (!same && beside_label != kNone) {
      same = coder_.bit(other_label_, label == beside_label);
      if (same) label = beside_label;
    }
    if (!same) label = code_magnitude(coder_, label_, label);
    labels_[t] = label;
    for (const std::uint32_t v : corners) last_at[v] = label;
    if (box && box->label == label && distance == 0) continue;
    const auto own = std::find_if(boxes_.begin(), boxes_.end(),
                                  [&](const LabelBox& b) { return b.label == label; });
    if (own == boxes_.end()) {
      // So many that a search for the nearest would take long are none of ours.
      if (boxes_.size() < kLargestRing) boxes_.push_back({label, place, place});
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      own->low[k] = std::min(own->low[k], place[k]);
      own->high[k] = std::max(own->high[k], place[k]);
    }
  }
}

}  // namespace crease::codec
