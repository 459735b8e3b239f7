#include "plain_decoder/pair_odds.h"

namespace plain {

namespace {

std::size_t class_of_triangles(std::size_t triangles) {
  return std::clamp<std::size_t>(triangles, 3, 10) - 3;
}
std::size_t class_of_child(std::size_t old_triangles) {
  return std::min<std::size_t>(old_triangles, 7) - 1;
}

// One of `low` up to but without `high`, by sums of odds from the first number on.
std::size_t halve(RangeDecoder& in, const std::vector<double>& sums, std::size_t low,
                  std::size_t high) {
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    if (in.known(sums[high] - sums[middle], sums[high] - sums[low])) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

}  // namespace

void PairOdds::rate(const std::vector<FanVertex>& fan) {
  const std::size_t n = fan.size();
  std::vector<double> l;
  double sum = 0;
  Vector A;
  for (const FanVertex& vertex : fan) {
    l.push_back(length(vertex.place));
    sum += l.back();
    A = A + vertex.place;
  }
  const double M = sum > 0 ? sum / double(n) : 1, h = 1 / M;
  const auto inverse = [&](std::size_t k) { return l[k] > 0 ? 1 / l[k] : 0; };

  features_.assign(n, {});
  std::vector<double> f(n);
  for (std::size_t k = 0; k < n; ++k) {
    const double a = std::min(l[k] * h, 3.0);
    features_[k] = {a, (a - 1) * (a - 1), fan[k].was_split ? 1.0 : 0.0};
    f[k] = triangles_[class_of_triangles(fan[k].triangles)];
    for (std::size_t x = 0; x < 3; ++x) f[k] += each_[x] * features_[k][x];
  }

  rated_.assign(n, std::vector<Rated>(n));
  double greatest = -1e300;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    Vector B = fan[i].place;
    for (std::size_t j = i + 1; j < n; ++j) {
      B = B + fan[j].place;
      const std::size_t I = j - i, O = n - I;
      const Vector E = fan[i].place + fan[j].place;
      const double x = std::min(length(B) * h / double(I + 1), 3.0);
      const double y = std::min(length(A - B + E) * h / double(O + 1), 3.0);
      const double c = dot(fan[i].place, fan[j].place) * inverse(i) * inverse(j);
      Rated& pair = rated_[i][j];
      pair.features = {std::min(length(E) * h * 0.5, 3.0),
                       std::min(x, y),
                       std::max(x, y),
                       std::abs(x - y),
                       x * y,
                       c * c};
      pair.odds = f[i] + f[j] + child_[class_of_child(I)] + child_[class_of_child(O)];
      for (std::size_t k = 0; k < 6; ++k) pair.odds += both_[k] * pair.features[k];
      greatest = std::max(greatest, pair.odds);
    }
  }
  all_ = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      rated_[i][j].odds = power_of_2((rated_[i][j].odds - greatest) * 1.4427);
      all_ += rated_[i][j].odds;
    }
  }
}

PairOdds::Pair PairOdds::read(RangeDecoder& in, const std::vector<FanVertex>& fan) {
  rate(fan);
  const std::size_t n = fan.size();
  std::vector<double> U(n + 1, 0.0), V(n + 1, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    double sum = 0;
    for (std::size_t j = i + 1; j < n; ++j) sum += rated_[i][j].odds;
    U[i + 1] = U[i] + sum;
  }
  Pair pair;
  pair.i = halve(in, U, 0, n - 1);
  V[pair.i + 1] = 0;
  for (std::size_t j = pair.i + 1; j < n; ++j) V[j + 1] = V[j] + rated_[pair.i][j].odds;
  pair.j = halve(in, V, pair.i + 1, n);
  learn(fan, pair);
  return pair;
}

void PairOdds::learn(const std::vector<FanVertex>& fan, const Pair& pair) {
  const std::size_t n = fan.size();
  if (!(all_ > 0)) return;
  std::array<double, 6> of_both{};
  std::vector<double> of_vertex(n, 0.0), of_length(n, 0.0);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const bool was_it = i == pair.i && j == pair.j;
      const double less = was_it ? rated_[i][j].odds - all_ : rated_[i][j].odds;
      const double surplus = less * (kPairRate / all_);
      for (std::size_t k = 0; k < 6; ++k) of_both[k] += surplus * rated_[i][j].features[k];
      of_vertex[i] += surplus;
      of_vertex[j] += surplus;
      of_length[j - i] += surplus;
    }
  }
  for (std::size_t k = 0; k < 6; ++k) both_[k] -= kBothRates[k] * of_both[k];
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t c = class_of_triangles(fan[i].triangles);
    triangles_[c] -= kTrianglesRates[c] * of_vertex[i];
    for (std::size_t x = 0; x < 3; ++x) {
      each_[x] -= kEachRates[x] * of_vertex[i] * features_[i][x];
    }
  }
  for (std::size_t I = 1; I < n; ++I) {
    const std::size_t one = class_of_child(I), other = class_of_child(n - I);
    child_[one] -= kChildRates[one] * of_length[I];
    child_[other] -= kChildRates[other] * of_length[I];
  }
}

}  // namespace plain
