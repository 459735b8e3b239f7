#include "codec/pair_odds.h"

#include "base/wide.h"
#include "codec/eight_floats.h"

#include <algorithm>
#include <bit>
#include <cmath>

#if defined(CREASE_AVX2)
#include <immintrin.h>
#endif

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
void put_at(float* x, const FourFloats& four) {
  std::memcpy(x, &four, sizeof four);
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

// All bits of the first 0 to 4 lanes.
constexpr std::array<FourInts, 5> kLanes{
    FourInts{}, {-1, 0, 0, 0}, {-1, -1, 0, 0}, {-1, -1, -1, 0}, {-1, -1, -1, -1}};

#if defined(CREASE_AVX2)

// Two fours side by side.
[[gnu::always_inline]] CREASE_AVX2 inline __m256 two_at(const float* a, const float* b) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(a)), _mm_loadu_ps(b), 1);
}
[[gnu::always_inline]] CREASE_AVX2 inline __m256 two_of(const float& a, const float& b) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_broadcast_ss(&a)), _mm_broadcast_ss(&b),
                              1);
}
[[gnu::always_inline]] CREASE_AVX2 inline __m256 two_of(const FourInts& a, const FourInts& b) {
  return two_at(reinterpret_cast<const float*>(&a), reinterpret_cast<const float*>(&b));
}

// rough_exp2_of_each() of x + 64.
[[gnu::always_inline]] CREASE_AVX2 inline __m256 exp2_wide(__m256 x) {
  const __m256i whole = _mm256_cvttps_epi32(x);
  const __m256 t = x - _mm256_cvtepi32_ps(whole);
  const __m256i power = _mm256_slli_epi32(_mm256_add_epi32(whole, _mm256_set1_epi32(127 - 64)), 23);
  return _mm256_castsi256_ps(power) * (1.0f + t - 0.34f * t * (1.0f - t));
}

#endif

}  // namespace

// The fours of a ring of n vertices: of pairs (first, last), (first, last + 1) and so on. One more
// without pairs makes their number even.
struct PairOdds::Plan {
  struct Four {
    std::uint8_t first = 0, last = 0, pairs = 0;
  };
  std::array<Four, kFours> fours{};
  std::array<std::uint8_t, kMost + 1> row{};  // where the fours of each first begin
  std::size_t count = 0;

  constexpr Plan(std::size_t n) {
    for (std::size_t i = 0; i + 1 < n; ++i) {
      row[i] = static_cast<std::uint8_t>(count);
      for (std::size_t j = i + 1; j < n; j += 4, ++count) {
        fours[count] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j),
                        static_cast<std::uint8_t>(std::min<std::size_t>(n - j, 4))};
      }
    }
    if (n > 0) row[n - 1] = static_cast<std::uint8_t>(count);
    if (count < kFours) fours[count] = {0, static_cast<std::uint8_t>(n), 0};
  }
};

constexpr PairOdds::Plan PairOdds::kPlans[] = {0, 1,  2,  3,  4,  5,  6,  7, 8,
                                               9, 10, 11, 12, 13, 14, 15, 16};

const FourFloats* PairOdds::odds_of(std::uint32_t first) const {
  return &odds_[kPlans[count_].row[first]];
}

// What speaks for each vertex, and for each number of triangles that go to a child.
void PairOdds::rate_vertices(std::span<const RingVertex> ring, Rated& rated) {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    const float l = std::min(vertex_features_[i][0] * rated.inverse, kFarthest);
    vertex_features_[i] = {l, (l - 1) * (l - 1), ring[i].was_split ? 1.0f : 0.0f};
    triangles_class_[i] = std::clamp<std::size_t>(ring[i].triangles, 3, 10) - 3;
    float score = of_triangles_[triangles_class_[i]];
    for (std::size_t k = 0; k < kOfVertex; ++k) score += of_vertex_[k] * vertex_features_[i][k];
    rated.of_vertex[i] = score;
  }
  for (std::size_t arc = 1; arc < n; ++arc) {
    rated.of_arc[arc] = of_child_[child_class(arc)] + of_child_[child_class(n - arc)];
  }
}

CREASE_WIDE void PairOdds::rate(std::span<const Spot> places, std::span<const RingVertex> ring) {
  const std::size_t n = ring.size();
  count_ = static_cast<std::uint32_t>(n);
  Rated rated;
  const std::size_t behind = (n + 3) / 4 * 4;
  for (PerVertex* const numbers : {&rated.x, &rated.y, &rated.z, &rated.sum_x, &rated.sum_y,
                                   &rated.sum_z, &rated.inverse_length}) {
    put_at(numbers->data() + behind, FourFloats{});
  }
  for (PerVertex* const numbers : {&rated.of_vertex, &rated.of_arc}) {
    put_at(numbers->data() + n, FourFloats{});
  }
  PerVertex lengths;
  for (std::size_t i = 0; i < n; i += 4) {
    std::array<Spot, 4> four{}, sums;
    for (std::size_t k = 0; k < 4; ++k) {
      if (i + k < n) four[k] = places[i + k];
      sums[k] = rated.all += four[k];
    }
    const auto [x, y, z] = coordinates_of(four[0], four[1], four[2], four[3]);
    const auto [sum_x, sum_y, sum_z] = coordinates_of(sums[0], sums[1], sums[2], sums[3]);
    put_at(&rated.x[i], x);
    put_at(&rated.y[i], y);
    put_at(&rated.z[i], z);
    put_at(&rated.sum_x[i], sum_x);
    put_at(&rated.sum_y[i], sum_y);
    put_at(&rated.sum_z[i], sum_z);
    const FourFloats l = root(x * x + y * y + z * z), inverse = 1.0f / l;
    put_at(&lengths[i], l);
    put_at(&rated.inverse_length[i],
           std::bit_cast<FourFloats>(std::bit_cast<FourInts>(inverse) & (l > FourFloats{})));
  }
  float mean = 0;
  for (std::size_t i = 0; i < n; ++i) {
    vertex_features_[i][0] = lengths[i];
    mean += lengths[i];
  }
  rated.inverse = 1 / (mean > 0 ? mean / static_cast<float>(n) : 1);
  rate_vertices(ring, rated);
#if defined(CREASE_AVX2)
  if (has_avx2()) {
    rate_pairs_wide(rated);
  } else
#endif
  {
    rate_pairs(rated);
  }
  const Plan& plan = kPlans[n];
  sum_ = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    FourFloats sum{};
    for (std::size_t f = plan.row[i]; f < plan.row[i + 1]; ++f) sum += odds_[f];
    up_to_[i] = sum_ += sum_of(sum);
  }
}

void PairOdds::rate_pairs(const Rated& r) {
  const Plan& plan = kPlans[count_];
  const std::size_t n = count_;
  const FourFloats farthest = FourFloats{} + kFarthest;
  FourFloats greatest = FourFloats{} - 1e30f;
  for (std::size_t f = 0; f < plan.count; ++f) {
    const std::size_t i = plan.fours[f].first, j = plan.fours[f].last;
    const FourFloats qx = four_at(&r.x[j]), qy = four_at(&r.y[j]), qz = four_at(&r.z[j]);
    const FourFloats ex = qx + r.x[i], ey = qy + r.y[i], ez = qz + r.z[i];
    // Of the vertices i to j, and of the others with those two.
    const Spot before = i > 0 ? Spot{r.sum_x[i - 1], r.sum_y[i - 1], r.sum_z[i - 1], 0} : Spot{};
    const Spot outside = r.all + before;
    const FourFloats sx = four_at(&r.sum_x[j]), sy = four_at(&r.sum_y[j]),
                     sz = four_at(&r.sum_z[j]);
    const FourFloats ax = sx - before[0], ay = sy - before[1], az = sz - before[2];
    const FourFloats bx = outside[0] - sx + ex, by = outside[1] - sy + ey,
                     bz = outside[2] - sz + ez;
    const FourFloats ends = root(ex * ex + ey * ey + ez * ez) * r.inverse * 0.5f;
    const FourFloats a = lesser(
        root(ax * ax + ay * ay + az * az) * r.inverse * four_at(&kInverse[j - i + 1]), farthest);
    const FourFloats b = lesser(
        root(bx * bx + by * by + bz * bz) * r.inverse * four_at(&kInverseDown[16 - n + j - i]),
        farthest);
    const FourFloats cosine = (qx * r.x[i] + qy * r.y[i] + qz * r.z[i]) * r.inverse_length[i] *
                              four_at(&r.inverse_length[j]);
    const FourFloats features[] = {lesser(ends, farthest),       lesser(a, b), greater(a, b),
                                   greater(a, b) - lesser(a, b), a * b,        cosine * cosine};
    FourFloats score = r.of_vertex[i] + four_at(&r.of_vertex[j]) + four_at(&r.of_arc[j - i]);
    for (std::size_t k = 0; k < kOfPair; ++k) {
      pair_features_[k][f] = features[k];
      score = score + of_pair_[k] * features[k];
    }
    odds_[f] = first_of(score, plan.fours[f].pairs, -1e30f);
    greatest = greater(odds_[f], greatest);
  }
  const float most = std::max({greatest[0], greatest[1], greatest[2], greatest[3]});
  for (std::size_t f = 0; f < plan.count; ++f) {
    const FourFloats over =
        lesser(greater((odds_[f] - most) * 1.4427f, FourFloats{} - 60), FourFloats{});
    odds_[f] = first_of(rough_exp2_of_each(over + 64), plan.fours[f].pairs, 0);
  }
}

#if defined(CREASE_AVX2)

// The same, two fours at once.
CREASE_AVX2 void PairOdds::rate_pairs_wide(const Rated& r) {
  const Plan& plan = kPlans[count_];
  const std::size_t n = count_;
  const __m256 farthest = _mm256_set1_ps(kFarthest), least = _mm256_set1_ps(-1e30f);
  __m256 greatest = least;
  static constexpr float kNothing = 0;
  for (std::size_t f = 0; f < plan.count; f += 2) {
    const Plan::Four &one = plan.fours[f], &two = plan.fours[f + 1];
    const std::size_t i = one.first, j = one.last, k = two.first, l = two.last;
    const __m256 px = two_of(r.x[i], r.x[k]), py = two_of(r.y[i], r.y[k]),
                 pz = two_of(r.z[i], r.z[k]);
    const __m256 qx = two_at(&r.x[j], &r.x[l]), qy = two_at(&r.y[j], &r.y[l]),
                 qz = two_at(&r.z[j], &r.z[l]);
    const __m256 ex = qx + px, ey = qy + py, ez = qz + pz;
    const auto before = [](const PerVertex& sums, std::size_t v) -> const float& {
      return v > 0 ? sums[v - 1] : kNothing;
    };
    const __m256 before_x = two_of(before(r.sum_x, i), before(r.sum_x, k)),
                 before_y = two_of(before(r.sum_y, i), before(r.sum_y, k)),
                 before_z = two_of(before(r.sum_z, i), before(r.sum_z, k));
    const __m256 sx = two_at(&r.sum_x[j], &r.sum_x[l]), sy = two_at(&r.sum_y[j], &r.sum_y[l]),
                 sz = two_at(&r.sum_z[j], &r.sum_z[l]);
    const __m256 ax = sx - before_x, ay = sy - before_y, az = sz - before_z;
    const __m256 bx = r.all[0] + before_x - sx + ex, by = r.all[1] + before_y - sy + ey,
                 bz = r.all[2] + before_z - sz + ez;
    const __m256 ends = _mm256_sqrt_ps(ex * ex + ey * ey + ez * ez) * r.inverse * 0.5f;
    const __m256 a = _mm256_min_ps(_mm256_sqrt_ps(ax * ax + ay * ay + az * az) * r.inverse *
                                       two_at(&kInverse[j - i + 1], &kInverse[l - k + 1]),
                                   farthest);
    const __m256 b =
        _mm256_min_ps(_mm256_sqrt_ps(bx * bx + by * by + bz * bz) * r.inverse *
                          two_at(&kInverseDown[16 - n + j - i], &kInverseDown[16 - n + l - k]),
                      farthest);
    const __m256 cosine = (qx * px + qy * py + qz * pz) *
                          two_of(r.inverse_length[i], r.inverse_length[k]) *
                          two_at(&r.inverse_length[j], &r.inverse_length[l]);
    const __m256 lesser_of = _mm256_min_ps(a, b), greater_of = _mm256_max_ps(a, b);
    const __m256 features[] = {_mm256_min_ps(ends, farthest), lesser_of, greater_of,
                               greater_of - lesser_of,        a * b,     cosine * cosine};
    __m256 score = two_of(r.of_vertex[i], r.of_vertex[k]) +
                   two_at(&r.of_vertex[j], &r.of_vertex[l]) +
                   two_at(&r.of_arc[j - i], &r.of_arc[l - k]);
    for (std::size_t m = 0; m < kOfPair; ++m) {
      _mm256_storeu_ps(reinterpret_cast<float*>(&pair_features_[m][f]), features[m]);
      score = score + of_pair_[m] * features[m];
    }
    const __m256 odds =
        _mm256_blendv_ps(least, score, two_of(kLanes[one.pairs], kLanes[two.pairs]));
    _mm256_storeu_ps(reinterpret_cast<float*>(&odds_[f]), odds);
    greatest = _mm256_max_ps(odds, greatest);
  }
  __m128 most = _mm_max_ps(_mm256_castps256_ps128(greatest), _mm256_extractf128_ps(greatest, 1));
  most = _mm_max_ps(most, _mm_movehl_ps(most, most));
  most = _mm_max_ps(most, _mm_movehdup_ps(most));
  const __m256 top = _mm256_broadcastss_ps(most);
  for (std::size_t f = 0; f < plan.count; f += 2) {
    float* const odds = reinterpret_cast<float*>(&odds_[f]);
    const __m256 over =
        _mm256_min_ps(_mm256_max_ps((_mm256_loadu_ps(odds) - top) * 1.4427f, _mm256_set1_ps(-60)),
                      _mm256_setzero_ps());
    const __m256 pairs = two_of(kLanes[plan.fours[f].pairs], kLanes[plan.fours[f + 1].pairs]);
    _mm256_storeu_ps(odds, _mm256_and_ps(exp2_wide(over + 64.0f), pairs));
  }
}

#endif

// A step down the slope of -log(odds / sum).
CREASE_WIDE void PairOdds::learn(const Pair& pair) {
  const std::size_t n = count_;
  if (!(sum_ > 0)) return;
  const Plan& plan = kPlans[n];
  const std::size_t place = pair.last - pair.first - 1;
  FourFloats& right = odds_[plan.row[pair.first] + place / 4];
  right -=
      std::bit_cast<FourFloats>((FourInts{0, 1, 2, 3} == static_cast<std::int32_t>(place % 4)) &
                                std::bit_cast<FourInts>(FourFloats{} + sum_));
  const float scale = kRate / sum_;
  std::array<FourFloats, kOfPair> by_pair{};
  PerVertex by_first{}, by_last{}, by_arc{};
  for (std::size_t i = 0; i + 1 < n; ++i) {
    FourFloats of_row{};
    for (std::size_t f = plan.row[i], j = i + 1; f < plan.row[i + 1]; ++f, j += 4) {
      const FourFloats over = odds_[f] * scale;
      for (std::size_t k = 0; k < kOfPair; ++k) by_pair[k] += over * pair_features_[k][f];
      of_row += over;
      put_at(&by_last[j], four_at(&by_last[j]) + over);
      put_at(&by_arc[j - i], four_at(&by_arc[j - i]) + over);
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
