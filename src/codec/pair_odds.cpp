#include "codec/pair_odds.h"

#include "codec/deterministic_math.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

// How fast weights learn: over what the feature varies by among the pairs of scans, CAD and city
// models.
constexpr double kRate = 0.015;
constexpr double kPairRates[] = {5.9, 24, 9.5, 8.5, 12.7, 7.5};
constexpr double kVertexRates[] = {2.2, 1.7, 1.5};
constexpr double kTrianglesRates[] = {12, 5, 2.7, 2.2, 3.5, 6.9, 17.8, 12.9};
constexpr double kChildRates[] = {4.5, 4.4, 3.5, 3.5, 4.7, 5.8, 6};

constexpr double kFarthest = 3;  // of lengths beside the mean one

}  // namespace

std::size_t PairOdds::child_class(std::size_t arc) const {
  return std::min<std::size_t>(arc + 2, 9) - 3;
}

void PairOdds::rate(std::span<const RingVertex> ring) {
  const std::size_t n = ring.size();
  count_ = static_cast<std::uint32_t>(n);
  std::array<double, kMost> of_vertex, inverse_length;
  Vec3d all{};
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double l = length(ring[i].position);
    inverse_length[i] = l > 0 ? 1 / l : 0;
    vertex_features_[i][0] = l;
    mean += l;
    all += ring[i].position;
  }
  mean = mean > 0 ? mean / double(n) : 1;
  const double inverse = 1 / mean;
  for (std::size_t i = 0; i < n; ++i) {
    const double l = std::min(vertex_features_[i][0] * inverse, kFarthest);
    vertex_features_[i] = {l, (l - 1) * (l - 1), ring[i].was_split ? 1.0 : 0.0};
    triangles_class_[i] = std::clamp<std::size_t>(ring[i].triangles, 3, 10) - 3;
    of_vertex[i] = of_triangles_[triangles_class_[i]];
    for (std::size_t k = 0; k < kOfVertex; ++k) {
      of_vertex[i] += of_vertex_[k] * vertex_features_[i][k];
    }
  }
  double greatest = -1e300;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    Vec3d arc = ring[i].position;
    for (std::size_t j = i + 1; j < n; ++j) {
      arc += ring[j].position;  // of the vertices i to j
      const std::size_t inside = j - i, outside = n - inside;
      const Vec3d ends = ring[i].position + ring[j].position;
      const double a = std::min(length(arc) * inverse / double(inside + 1), kFarthest);
      const double b =
          std::min(length(all - arc + ends) * inverse / double(outside + 1), kFarthest);
      const double cosine =
          dot(ring[i].position, ring[j].position) * inverse_length[i] * inverse_length[j];
      std::array<double, kOfPair>& features = pair_features_[i][j];
      features = {std::min(length(ends) * inverse * 0.5, kFarthest),
                  std::min(a, b),
                  std::max(a, b),
                  std::abs(a - b),
                  a * b,
                  cosine * cosine};
      double score = of_vertex[i] + of_vertex[j] + of_child_[child_class(inside)] +
                     of_child_[child_class(outside)];
      for (std::size_t k = 0; k < kOfPair; ++k) score += of_pair_[k] * features[k];
      odds_[i][j] = score;
      greatest = std::max(greatest, score);
    }
  }
  sum_ = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      odds_[i][j] = rough_exp2((odds_[i][j] - greatest) * 1.4427);
      sum_ += odds_[i][j];
    }
  }
}

// A step down the slope of -log(odds / sum).
void PairOdds::learn(const Pair& pair) {
  const std::size_t n = count_;
  if (!(sum_ > 0)) return;
  std::array<double, kOfPair> by_pair{};
  std::array<double, kMost> by_vertex{}, by_arc{};
  odds_[pair.first][pair.last] -= sum_;
  const double scale = kRate / sum_;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const double over = odds_[i][j] * scale;
      by_vertex[i] += over;
      by_vertex[j] += over;
      by_arc[j - i] += over;
      for (std::size_t k = 0; k < kOfPair; ++k) by_pair[k] += over * pair_features_[i][j][k];
    }
  }
  for (std::size_t k = 0; k < kOfPair; ++k) of_pair_[k] -= kPairRates[k] * by_pair[k];
  for (std::size_t i = 0; i < n; ++i) {
    of_triangles_[triangles_class_[i]] -= kTrianglesRates[triangles_class_[i]] * by_vertex[i];
    for (std::size_t k = 0; k < kOfVertex; ++k) {
      of_vertex_[k] -= kVertexRates[k] * by_vertex[i] * vertex_features_[i][k];
    }
  }
  for (std::size_t arc = 1; arc < n; ++arc) {
    const std::size_t one = child_class(arc), other = child_class(n - arc);
    of_child_[one] -= kChildRates[one] * by_arc[arc];
    of_child_[other] -= kChildRates[other] * by_arc[arc];
  }
}

}  // namespace crease::codec
