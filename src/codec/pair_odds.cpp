#include "codec/pair_odds.h"

#include "base/wide.h"
#include "codec/eight_floats.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace crease::codec {

namespace {

// How fast weights learn: over what the feature varies by among the pairs of scans, CAD and city
// models.
constexpr float kRate = 0.015f;
constexpr float kPairRates[] = {5.9f, 24, 9.5f, 8.5f, 12.7f, 7.5f};
constexpr float kVertexRates[] = {2.2f, 1.7f, 1.5f};
constexpr float kTrianglesRates[] = {12, 5, 2.7f, 2.2f, 3.5f, 6.9f, 17.8f, 12.9f};
constexpr float kChildRates[] = {4.5f, 4.4f, 3.5f, 3.5f, 4.7f, 5.8f, 6};

constexpr float kFarthest = 3;  // of lengths beside the mean one

// Of a child with so many old triangles.
std::size_t child_class(std::size_t arc) {
  return std::min<std::size_t>(arc, 7) - 1;
}

// 1 / 1, 1 / 2, ... from [1] on, and the same downwards to 1 / 1.
constexpr std::array<float, 24> kInverse = [] {
  std::array<float, 24> inverse{};
  for (int i = 1; i < 24; ++i) inverse[std::size_t(i)] = 1 / static_cast<float>(i);
  return inverse;
}();
constexpr std::array<float, 24> kInverseDown = [] {
  std::array<float, 24> inverse{};
  for (int i = 0; i < 17; ++i) inverse[std::size_t(i)] = 1 / static_cast<float>(17 - i);
  return inverse;
}();

// Four numbers from there on.
FourFloats four_at(const float* x) {
  FourFloats four;
  std::memcpy(&four, x, sizeof four);
  return four;
}
void add_at(float* x, const FourFloats& more) {
  const FourFloats sum = four_at(x) + more;
  std::memcpy(x, &sum, sizeof sum);
}
float sum_of(const FourFloats& x) {
  return (x[0] + x[1]) + (x[2] + x[3]);
}
// Of the first `count`, others replaced.
FourFloats first_of(const FourFloats& x, std::size_t count, float other) {
  const FourInts is_one = FourInts{0, 1, 2, 3} < static_cast<std::int32_t>(count);
  return std::bit_cast<FourFloats>((std::bit_cast<FourInts>(x) & is_one) |
                                   (std::bit_cast<FourInts>(FourFloats{} + other) & ~is_one));
}

}  // namespace

// What speaks for each vertex.
PairOdds::PerVertex PairOdds::rate_vertices(std::span<const RingVertex> ring, float inverse) {
  PerVertex rated{};
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const float l = std::min(vertex_features_[i][0] * inverse, kFarthest);
    vertex_features_[i] = {l, (l - 1) * (l - 1), ring[i].was_split ? 1.0f : 0.0f};
    triangles_class_[i] = std::clamp<std::size_t>(ring[i].triangles, 3, 10) - 3;
    rated[i] = of_triangles_[triangles_class_[i]];
    for (std::size_t k = 0; k < kOfVertex; ++k) rated[i] += of_vertex_[k] * vertex_features_[i][k];
  }
  return rated;
}

CREASE_WIDE void PairOdds::rate(std::span<const Spot> places, std::span<const RingVertex> ring) {
  const std::size_t n = ring.size();
  count_ = static_cast<std::uint32_t>(n);
  PerVertex x{}, y{}, z{}, sum_x{}, sum_y{}, sum_z{}, inverse_length{}, of_arc{};
  Spot to_there{};
  for (std::size_t i = 0; i < n; ++i) {
    const Spot& p = places[i];
    to_there += p;
    x[i] = p[0], y[i] = p[1], z[i] = p[2];
    sum_x[i] = to_there[0], sum_y[i] = to_there[1], sum_z[i] = to_there[2];
  }
  PerVertex lengths;
  for (std::size_t i = 0; i < n; i += 4) {
    const FourFloats px = four_at(&x[i]), py = four_at(&y[i]), pz = four_at(&z[i]);
    const FourFloats l = root(px * px + py * py + pz * pz), inverse = 1.0f / l;
    const FourFloats known =
        std::bit_cast<FourFloats>(std::bit_cast<FourInts>(inverse) & (l > FourFloats{}));
    std::memcpy(&lengths[i], &l, sizeof l);
    std::memcpy(&inverse_length[i], &known, sizeof known);
  }
  const Vec3f all{to_there[0], to_there[1], to_there[2]};
  float mean = 0;
  for (std::size_t i = 0; i < n; ++i) {
    vertex_features_[i][0] = lengths[i];
    mean += lengths[i];
  }
  mean = mean > 0 ? mean / static_cast<float>(n) : 1;
  const float inverse = 1 / mean;
  const PerVertex of_vertex = rate_vertices(ring, inverse);
  for (std::size_t arc = 1; arc < n; ++arc) {
    of_arc[arc] = of_child_[child_class(arc)] + of_child_[child_class(n - arc)];
  }

  const FourFloats farthest = FourFloats{} + kFarthest;
  FourFloats greatest = FourFloats{} - 1e30f;
  std::size_t four = 0;
  Vec3f before{};  // the sum of those before i
  for (std::size_t i = 0; i + 1 < n; ++i) {
    row_[i] = four;
    const Vec3f p{x[i], y[i], z[i]}, outside = all + before;
    for (std::size_t j = i + 1; j < n; j += 4, ++four) {
      const FourFloats qx = four_at(&x[j]), qy = four_at(&y[j]), qz = four_at(&z[j]);
      const FourFloats ex = qx + p.x, ey = qy + p.y, ez = qz + p.z;
      // Of the vertices i to j, and of the others with those two.
      const FourFloats sx = four_at(&sum_x[j]), sy = four_at(&sum_y[j]), sz = four_at(&sum_z[j]);
      const FourFloats ax = sx - before.x, ay = sy - before.y, az = sz - before.z;
      const FourFloats bx = outside.x - sx + ex, by = outside.y - sy + ey, bz = outside.z - sz + ez;
      const FourFloats ends = root(ex * ex + ey * ey + ez * ez) * inverse * 0.5f;
      const FourFloats a = lesser(
          root(ax * ax + ay * ay + az * az) * inverse * four_at(&kInverse[j - i + 1]), farthest);
      const FourFloats b = lesser(
          root(bx * bx + by * by + bz * bz) * inverse * four_at(&kInverseDown[16 - n + j - i]),
          farthest);
      const FourFloats cosine =
          (qx * p.x + qy * p.y + qz * p.z) * inverse_length[i] * four_at(&inverse_length[j]);
      const FourFloats features[] = {lesser(ends, farthest),       lesser(a, b), greater(a, b),
                                     greater(a, b) - lesser(a, b), a * b,        cosine * cosine};
      FourFloats score = of_vertex[i] + four_at(&of_vertex[j]) + four_at(&of_arc[j - i]);
      for (std::size_t k = 0; k < kOfPair; ++k) {
        pair_features_[k][four] = features[k];
        score = score + of_pair_[k] * features[k];
      }
      odds_[four] = first_of(score, n - j, -1e30f);
      greatest = greater(odds_[four], greatest);
    }
    before = {sum_x[i], sum_y[i], sum_z[i]};
  }
  row_[n - 1] = four;
  const float most = std::max({greatest[0], greatest[1], greatest[2], greatest[3]});
  sum_ = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    FourFloats sum{};
    for (std::size_t f = row_[i], j = i + 1; f < row_[i + 1]; ++f, j += 4) {
      const FourFloats over =
          lesser(greater((odds_[f] - most) * 1.4427f, FourFloats{} - 60), FourFloats{});
      odds_[f] = first_of(rough_exp2_of_each(over + 64), n - j, 0);
      sum += odds_[f];
    }
    up_to_[i] = sum_ += sum_of(sum);
  }
}

// A step down the slope of -log(odds / sum).
CREASE_WIDE void PairOdds::learn(const Pair& pair) {
  const std::size_t n = count_;
  if (!(sum_ > 0)) return;
  const std::size_t place = pair.last - pair.first - 1;
  odds_[row_[pair.first] + place / 4][place % 4] -= sum_;
  const float scale = kRate / sum_;
  std::array<FourFloats, kOfPair> by_pair{};
  PerVertex by_first{}, by_last{}, by_arc{};
  for (std::size_t i = 0; i + 1 < n; ++i) {
    FourFloats of_row{};
    for (std::size_t f = row_[i], j = i + 1; f < row_[i + 1]; ++f, j += 4) {
      const FourFloats over = odds_[f] * scale;
      for (std::size_t k = 0; k < kOfPair; ++k) by_pair[k] += over * pair_features_[k][f];
      of_row += over;
      add_at(&by_last[j], over);
      add_at(&by_arc[j - i], over);
    }
    by_first[i] = sum_of(of_row);
  }
  for (std::size_t k = 0; k < kOfPair; ++k) of_pair_[k] -= kPairRates[k] * sum_of(by_pair[k]);
  for (std::size_t i = 0; i < n; ++i) {
    const float over = by_first[i] + by_last[i];
    of_triangles_[triangles_class_[i]] -= kTrianglesRates[triangles_class_[i]] * over;
    for (std::size_t k = 0; k < kOfVertex; ++k) {
      of_vertex_[k] -= kVertexRates[k] * over * vertex_features_[i][k];
    }
  }
  for (std::size_t arc = 1; arc < n; ++arc) {
    const std::size_t one = child_class(arc), other = child_class(n - arc);
    of_child_[one] -= kChildRates[one] * by_arc[arc];
    of_child_[other] -= kChildRates[other] * by_arc[arc];
  }
}

}  // namespace crease::codec
