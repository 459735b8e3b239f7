#include "plain_decoder/pair_odds.h"

namespace plain {

namespace {

std::size_t class_of_triangles(std::size_t triangles) {
  return std::clamp<std::size_t>(triangles, 3, 10) - 3;
}
std::size_t class_of_child(std::size_t old_triangles) {
  return std::min<std::size_t>(old_triangles, 7) - 1;
}

}  // namespace

void PairOdds::rate(const std::vector<FanVertex>& fan) {
  const std::size_t n = fan.size();
  std::vector<float> l;
  float sum = 0;
  std::vector<FloatVector> S;  // of those up to each
  for (const FanVertex& vertex : fan) {
    l.push_back(length(vertex.place));
    sum += l.back();
    S.push_back(S.empty() ? vertex.place : S.back() + vertex.place);
  }
  const float M = sum > 0 ? sum / float(n) : 1, h = 1 / M;
  const auto inverse = [&](std::size_t k) { return l[k] > 0 ? 1 / l[k] : 0.0f; };

  features_.assign(n, {});
  std::vector<float> f(n);
  for (std::size_t k = 0; k < n; ++k) {
    const float a = std::min(l[k] * h, 3.0f);
    features_[k] = {a, (a - 1) * (a - 1), fan[k].was_split ? 1.0f : 0.0f};
    f[k] = triangles_[class_of_triangles(fan[k].triangles)];
    for (std::size_t x = 0; x < 3; ++x) f[k] += each_[x] * features_[k][x];
  }

  rated_.assign(n, std::vector<Rated>(n));
  float greatest = -1e30f;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const FloatVector before = i > 0 ? S[i - 1] : FloatVector{};
    for (std::size_t j = i + 1; j < n; ++j) {
      const std::size_t I = j - i, O = n - I;
      const FloatVector E = fan[i].place + fan[j].place;
      const FloatVector inside = S[j] - before, outside = (S.back() + before) - S[j] + E;
      const float x = std::min(length(inside) * h * (1 / float(I + 1)), 3.0f);
      const float y = std::min(length(outside) * h * (1 / float(O + 1)), 3.0f);
      const float c = dot(fan[i].place, fan[j].place) * inverse(i) * inverse(j);
      Rated& pair = rated_[i][j];
      pair.features = {std::min(length(E) * h * 0.5f, 3.0f),
                       std::min(x, y),
                       std::max(x, y),
                       std::abs(x - y),
                       x * y,
                       c * c};
      pair.odds = f[i] + f[j] + (child_[class_of_child(I)] + child_[class_of_child(O)]);
      for (std::size_t k = 0; k < 6; ++k) pair.odds += both_[k] * pair.features[k];
      greatest = std::max(greatest, pair.odds);
    }
  }
  all_ = 0;
  sums_.clear();
  for (std::size_t i = 0; i + 1 < n; ++i) {
    std::vector<float> row;
    for (std::size_t j = i + 1; j < n; ++j) {
      rated_[i][j].odds = power_of_2((rated_[i][j].odds - greatest) * 1.4427f);
      row.push_back(rated_[i][j].odds);
    }
    all_ += sum_by_fours(row);
    sums_.push_back(all_);
  }
}

PairOdds::Pair PairOdds::read(RangeDecoder& in, const std::vector<FanVertex>& fan) {
  rate(fan);
  Pair pair;
  pair.i = in.one_of(sums_, 0, 16);
  std::vector<float> sums;
  float sum = 0;
  for (std::size_t j = pair.i + 1; j < fan.size(); ++j) {
    sum += rated_[pair.i][j].odds;
    sums.push_back(sum);
  }
  pair.j = pair.i + 1 + in.one_of(sums, 0, 16);
  learn(fan, pair);
  return pair;
}

void PairOdds::learn(const std::vector<FanVertex>& fan, const Pair& pair) {
  const std::size_t n = fan.size();
  if (!(all_ > 0)) return;
  std::array<std::array<float, 4>, 6> of_both{};  // in four parts
  std::vector<float> of_first(n, 0.0f), of_last(n, 0.0f), of_length(n, 0.0f);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    std::vector<float> row;
    for (std::size_t j = i + 1; j < n; ++j) {
      const bool was_it = i == pair.i && j == pair.j;
      const float less = was_it ? rated_[i][j].odds - all_ : rated_[i][j].odds;
      const float surplus = less * (kPairRate / all_);
      for (std::size_t k = 0; k < 6; ++k) {
        of_both[k][(j - i - 1) % 4] += surplus * rated_[i][j].features[k];
      }
      row.push_back(surplus);
      of_last[j] += surplus;
      of_length[j - i] += surplus;
    }
    of_first[i] = sum_by_fours(row);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    both_[k] -= kBothRates[k] * sum_by_fours({of_both[k].begin(), of_both[k].end()});
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t c = class_of_triangles(fan[i].triangles);
    const float of_vertex = of_first[i] + of_last[i];
    triangles_[c] -= kTrianglesRates[c] * of_vertex;
    for (std::size_t x = 0; x < 3; ++x) {
      each_[x] -= kEachRates[x] * of_vertex * features_[i][x];
    }
  }
  for (std::size_t I = 1; I < n; ++I) {
    const std::size_t one = class_of_child(I), other = class_of_child(n - I);
    child_[one] -= kChildRates[one] * of_length[I];
    child_[other] -= kChildRates[other] * of_length[I];
  }
}

}  // namespace plain
