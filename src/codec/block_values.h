// The values of attributes at the fine end of a block; included by block_coder.h.
#pragma once

#include <cmath>
#include "codec/block_coder.h"
#include "codec/deterministic_math.h"

namespace crease::codec {

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_layer(const BlockLayer& layer, std::vector<CodedValue>& values,
                                          std::size_t l) {
  LayerModels models;
  if constexpr (Coder::kEncodes) {  // in one go, since the guide has them elsewhere
    wanted_.resize(values.size());
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::uint32_t c = 0; c < 3; ++c) wanted_[3 * t + c] = guide_.value(l, t, c);
    }
  }
  is_known_.assign(values.size(), 0);
  for (std::uint32_t t = 0; t < coarse_triangles_; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      is_known_[3 * t + c] =
          !was_split(mesh_.triangles[t][c]) && !(layer.is_normal && was_derived_[t]);
    }
  }
  if (layer.octahedral_bits > 0) {
    start_directions(values, OctahedralCoding(layer.octahedral_bits));
  }
  for (std::uint32_t v = 0; v < mesh_.positions.size(); ++v) code_vertex(layer, values, models, v);
}

// Whether all corners at v are known.
template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::knows_corners(const BlockLayer& layer, std::uint32_t v) const {
  for (const std::uint32_t t : around_[v]) {
    if (!is_known_[3 * t + corner_of(mesh_.triangles[t], v)] &&
        !(layer.is_normal && mesh_.derived[t])) {
      return false;
    }
  }
  return true;
}

// The corners at one vertex. Mostly they share one value; else each is told to be like one that is
// known: beside it, at the coarse end, or at another corner of the triangle.
template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::code_vertex(const BlockLayer& layer, std::vector<CodedValue>& values,
                                           LayerModels& models, std::uint32_t v) {
  const auto shows = [&](std::uint32_t t) { return !(layer.is_normal && mesh_.derived[t]); };
  if (knows_corners(layer, v)) return;
  corners_.clear();
  const bool fan = find_ring(mesh_.triangles, around_[v], v, ring_);
  CodedValue known{};
  std::size_t known_values = 0;  // distinct ones, up to two
  for (std::uint32_t t : fan ? ring_.triangles : around_[v]) {
    if (!shows(t)) continue;
    const std::uint32_t corner = 3 * t + std::uint32_t(corner_of(mesh_.triangles[t], v));
    corners_.push_back(corner);
    if (!is_known_[corner]) continue;
    if (known_values == 0) {
      known = values[corner];
      known_values = 1;
    } else if (values[corner] != known) {
      known_values = 2;
    }
  }
  if (fan && ring_.closed) {  // from the oldest triangle on, at which most is known
    std::rotate(corners_.begin(), std::min_element(corners_.begin(), corners_.end()),
                corners_.end());
  }
  const auto value_of = [&](std::uint32_t corner) {
    CodedValue value{};
    if constexpr (Coder::kEncodes) value = wanted_[corner];
    return value;
  };
  const auto had_value = [&](std::uint32_t corner) { return had_at_coarse_end(layer, corner); };

  if (known_values < 2) {
    bool uniform = true;
    if constexpr (Coder::kEncodes) {
      const CodedValue first = value_of(corners_[0]);
      for (std::uint32_t corner : corners_) uniform = uniform && value_of(corner) == first;
    }
    std::size_t bends = 0;
    for (std::size_t i = 1; i < std::min(corners_.size(), kLargestRing); ++i) {
      bends = std::max(bends, bend(corners_[i - 1] / 3, corners_[i] / 3));
    }
    if (coder_.bit(models.is_uniform[known_values][bends], uniform)) {
      CodedValue value = known;
      if (known_values == 0) value = code_shared_value(layer, values, models, v);
      for (std::uint32_t corner : corners_) {
        values[corner] = value;
        is_known_[corner] = 1;
      }
      if (layer.octahedral_bits > 0) directions_.stored[v] = direction_of(layer, value);
      return;
    }
  }

  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::uint32_t corner = corners_[i], t = corner / 3;
    if (is_known_[corner]) continue;
    const CodedValue value = value_of(corner);
    tried_.clear();
    bool found = false;
    const auto try_value = [&](std::size_t kind, std::size_t bends, const CodedValue& candidate) {
      if (found || std::find(tried_.begin(), tried_.end(), candidate) != tried_.end()) return;
      if (coder_.bit(models.same_as[kind][tried_.size() > 0][bends], candidate == value)) {
        values[corner] = candidate;
        found = true;
      }
      tried_.push_back(candidate);
    };
    for (std::uint32_t c = 0; c < 3; ++c) {
      if (3 * t + c != corner && is_known_[3 * t + c]) try_value(0, 0, values[3 * t + c]);
    }
    const std::size_t last = corners_.size() - 1;
    const std::uint32_t previous = corners_[i > 0 ? i - 1 : last];
    const std::uint32_t next = corners_[i < last ? i + 1 : 0];
    for (const std::uint32_t beside : {previous, next}) {
      if (beside == corner || !is_known_[beside]) continue;
      try_value(1, bend(t, beside / 3), values[beside]);
    }
    if (had_value(corner)) try_value(2, 0, values[corner]);
    for (std::size_t k = 0; k < std::min(corners_.size(), kLargestRing) && !found; ++k) {
      if (tried_.size() >= kMostTried) break;
      if (!is_known_[corners_[k]]) continue;
      try_value(3, bend(t, corners_[k] / 3), values[corners_[k]]);
    }
    if (!found) {
      values[corner] =
          layer.octahedral_bits > 0
              ? code_corner_direction(layer, values, models, i, fan, value)
              : code_value(layer, models, value, tried_.empty() ? CodedValue{} : tried_.front());
    }
    is_known_[corner] = 1;
  }
}

template <class Coder, class Guide>
bool BlockCoder<Coder, Guide>::had_at_coarse_end(const BlockLayer& layer,
                                                 std::uint32_t corner) const {
  return !is_new(corner / 3) && !(layer.is_normal && was_derived_[corner / 3]);
}

template <class Coder, class Guide>
Vec3d BlockCoder<Coder, Guide>::direction_of(const BlockLayer& layer, const CodedValue& value) {
  const Vec3f d = OctahedralCoding(layer.octahedral_bits).decode(octahedral_code(value));
  return {double(d.x), double(d.y), double(d.z)};
}

// One value for all corners_ of v, none of which is known. A vertex that stays mostly keeps the
// one that it had.
template <class Coder, class Guide>
CodedValue BlockCoder<Coder, Guide>::code_shared_value(const BlockLayer& layer,
                                                       const std::vector<CodedValue>& values,
                                                       LayerModels& models, std::uint32_t v) {
  CodedValue value{}, had{};
  if constexpr (Coder::kEncodes) value = wanted_[corners_[0]];
  bool has_had = false;
  for (const std::uint32_t corner : corners_) {
    if (!had_at_coarse_end(layer, corner)) continue;
    had = values[corner];
    has_had = true;
  }
  if (has_had && coder_.bit(models.is_kept[has_moved_[v]][v >= coarse_vertices_], value == had)) {
    return had;
  }
  if (layer.octahedral_bits == 0) return code_value(layer, models, value, had);
  Sizes sizes;
  const DirectionCandidates candidates =
      direction_candidates(v, has_had ? direction_of(layer, had) : Vec3d{}, sizes);
  const OctahedralCoding coding(layer.octahedral_bits);
  DirectionMixture mixture = models.direction.mixture(coding, candidates, sizes);
  const CodedValue result = coded(code_direction(coder_, coding, mixture, octahedral_code(value)));
  models.direction.learn(mixture, sizes);
  return result;
}

// Of corners_[i], which none of the others is like: mostly its triangle's normal, or that of the
// triangles which go on from there without an edge. `fan`: corners_ are in the order of ring_.
template <class Coder, class Guide>
CodedValue BlockCoder<Coder, Guide>::code_corner_direction(const BlockLayer& layer,
                                                           const std::vector<CodedValue>& values,
                                                           LayerModels& models, std::size_t i,
                                                           bool fan, const CodedValue& value) {
  const std::uint32_t corner = corners_[i], t = corner / 3;
  const Vec3d own = areas_[t];
  Vec3d smooth = own, bent = own;
  const std::size_t count = corners_.size();
  for (const bool back : {false, true}) {
    if (!fan) break;
    bool is_smooth = true;
    std::uint32_t last = t;
    for (std::size_t k = 1; k < std::min(count, kFarthestBeside); ++k) {
      if (!ring_.closed && (back ? k > i : i + k >= count)) break;
      const std::uint32_t next = corners_[back ? (i + count - k) % count : (i + k) % count] / 3;
      const std::size_t turned = bend(last, next);
      is_smooth = is_smooth && turned < 2;
      if (turned > 2) break;
      if (is_smooth) smooth += areas_[next];
      bent += areas_[next];
      last = next;
    }
  }
  DirectionCandidates candidates;
  Vec3d beside{};
  for (std::uint32_t c = 0; c < 3; ++c) {
    if (3 * t + c != corner && is_known_[3 * t + c])
      beside += direction_of(layer, values[3 * t + c]);
  }
  const Vec3d had =
      had_at_coarse_end(layer, corner) ? direction_of(layer, values[corner]) : Vec3d{};
  const Vec3d first = tried_.empty() ? Vec3d{} : direction_of(layer, tried_.front());
  const Vec3d one = normalized(own);
  candidates.of = {one,
                   normalized(smooth),
                   had,
                   normalized(bent),
                   first,
                   normalized(beside),
                   directions_.geometric[mesh_.triangles[t][corner % 3]],
                   one};
  const double turned = length(normalized(smooth) - one);
  const auto size = [](double x) { return rough_log2(static_cast<float>(x)); };
  const Sizes sizes{size(turned + 0.002), size(length(had - one) + 0.002), size(length(own) + 1),
                    size(length(normalized(beside) - one) + 0.002)};
  const OctahedralCoding coding(layer.octahedral_bits);
  DirectionMixture mixture = models.corner_direction.mixture(coding, candidates, sizes);
  const CodedValue result = coded(code_direction(coder_, coding, mixture, octahedral_code(value)));
  models.corner_direction.learn(mixture, sizes);
  return result;
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::keep_coarse_normals() {
  bool any = false;
  for (const BlockLayer& layer : coding_.layers) any = any || layer.octahedral_bits > 0;
  if (!any) return;
  coarse_normals_.assign(coarse_vertices_, {});
  for (std::uint32_t t = 0; t < coarse_triangles_; ++t) {
    const Vec3d twice = twice_area(t);
    for (const std::uint32_t v : mesh_.triangles[t]) coarse_normals_[v] += twice;
  }
  for (Vec3d& n : coarse_normals_) n = normalized(n);
}

template <class Coder, class Guide>
void BlockCoder<Coder, Guide>::start_directions(const std::vector<CodedValue>& values,
                                                const OctahedralCoding& coding) {
  const std::size_t vertices = mesh_.positions.size();
  directions_.geometric.assign(vertices, {});
  directions_.stored.assign(vertices, {});
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const Vec3d& twice = areas_[t];
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = mesh_.triangles[t][c];
      directions_.geometric[v] += twice;
      if (!is_known_[3 * t + c] || directions_.stored[v] != Vec3d{}) continue;
      const Vec3f d = coding.decode(octahedral_code(values[3 * t + c]));
      directions_.stored[v] = {double(d.x), double(d.y), double(d.z)};
    }
  }
  for (Vec3d& n : directions_.geometric) n = normalized(n);
}

template <class Coder, class Guide>
DirectionCandidates BlockCoder<Coder, Guide>::direction_candidates(std::uint32_t v,
                                                                   const Vec3d& had,
                                                                   Sizes& sizes) const {
  const Vec3d& geometric = directions_.geometric[v];
  Vec3d even{}, angles{}, off{}, beside{};
  double known = 0, spread = 0, count = 0;
  struct Neighbour {
    std::uint32_t vertex = kNone;
    Vec3d step;
    double square = 0;
  };
  const Vec3i& q = mesh_.positions[v];
  const auto seen = [&](std::uint32_t w) {
    const Vec3i& p = mesh_.positions[w];
    const Vec3d step{double(p.x) - q.x, double(p.y) - q.y, double(p.z) - q.z};
    return Neighbour{w, step, dot(step, step)};
  };
  const auto hear = [&](std::uint32_t w) {
    const Vec3d& stored = directions_.stored[w];
    if (stored == Vec3d{}) return;
    off += stored - directions_.geometric[w];
    beside += stored;
    known += 1;
  };
  const std::size_t triangles = std::min(around_[v].size(), kLargestRing);
  Neighbour a, b;
  for (const std::uint32_t t : around_[v].first(triangles)) {
    const Corners& corners = mesh_.triangles[t];
    const std::size_t c = corner_of(corners, v);
    const std::uint32_t after = corners[kCornerAfter[c]], before = corners[kCornerBefore[c]];
    a = b;  // mostly they follow each other
    if (after != b.vertex) a = seen(after);
    b = seen(before);
    const double lengths = a.square * b.square;
    if (lengths > 0) {
      const Vec3d n = cross(a.step, b.step);
      const double size = length(n), angle = rough_angle(size, dot(a.step, b.step));
      even += n * (1 / std::sqrt(lengths));
      angles += (size > 0 ? n * (1 / size) : n) * angle;
    }
    count += 1;
    spread += dot(directions_.geometric[after], geometric);
    hear(after);
    hear(before);
  }
  DirectionCandidates result;
  const Vec3d mean_off = known > 0 ? off * (1 / known) : Vec3d{};
  const std::uint32_t origin = origin_[v];
  result.of = {geometric,
               normalized(even),
               had,
               had == Vec3d{} || origin >= coarse_normals_.size()
                   ? Vec3d{}
                   : geometric + had - coarse_normals_[origin],
               known > 0 ? geometric + mean_off : Vec3d{},
               normalized(beside),
               normalized(angles),
               had == Vec3d{} ? Vec3d{} : had + geometric};
  const auto size = [](double x) { return rough_log2(static_cast<float>(x)); };
  sizes = {size(length(mean_off) + 0.002),
           size(std::sqrt(std::max(0.0, 1 - (count > 0 ? spread / count : 1))) + 0.002),
           size(length(had - geometric) + 0.002), known > 0 ? 1.0f : 0.0f};
  return result;
}

template <class Coder, class Guide>
CodedValue BlockCoder<Coder, Guide>::code_value(const BlockLayer& layer, LayerModels& models,
                                                const CodedValue& value,
                                                const CodedValue& predicted) {
  CodedValue result{};
  for (std::size_t k = 0; k < std::size_t(layer.dimension); ++k) {
    if (layer.is_raw) {
      const std::uint32_t bits = static_cast<std::uint32_t>(value[k]);
      const std::uint32_t high = coder_.uniform(1u << 16, bits >> 16);
      const std::uint32_t low = coder_.uniform(1u << 16, bits & 0xffff);
      result[k] = static_cast<std::int32_t>(high << 16 | low);
    } else {
      result[k] = wrapped_sum(
          predicted[k],
          code_signed(coder_, models.residual[k], wrapped_difference(value[k], predicted[k])));
    }
  }
  return result;
}

}  // namespace crease::codec
