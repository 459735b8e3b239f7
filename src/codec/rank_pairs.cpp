#include "codec/rank_pairs.h"

#include <algorithm>
#include <cmath>

namespace crease::codec {

namespace {

// Of a logistic model over splits of bunny, nefertiti, lucy, fandisk, berlin and kuka, with end
// points and with optimal places. Lengths are beside the ring's mean radius.
constexpr double kUneven = -0.2;    // difference of the children's triangles
constexpr double kFew = -0.47;      // triangles that a child lacks to five
constexpr double kThree = -0.8;     // a child of three triangles
constexpr double kBusy = -0.15;     // triangles at the two vertices
constexpr double kFar = -0.72;      // the two vertices' distances from the centre
constexpr double kAside = -1.3;     // their middle's distance
constexpr double kNearChild = 0.7;  // distance of the middle of one arc, the nearer one
constexpr double kFarChild = 1.95;  // and of the other

}  // namespace

void rank_pairs(std::span<const RingVertex> ring, std::vector<RingPair>& pairs) {
  const std::uint32_t n = static_cast<std::uint32_t>(ring.size());
  double mean = 0;
  for (const RingVertex& v : ring) mean += length(v.position);
  mean = mean > 0 ? mean / n : 1;
  const double inverse = 1 / mean;

  pairs.clear();
  Vec3d all{};
  for (const RingVertex& v : ring) all += v.position;
  for (std::uint32_t i = 0; i < n; ++i) {
    Vec3d arc = ring[i].position;
    for (std::uint32_t j = i + 1; j < n; ++j) {
      arc += ring[j].position;  // of the vertices i to j
      const double inside = j - i, outside = n - inside;
      const Vec3d ends = ring[i].position + ring[j].position;
      const double a = length(arc) * inverse / (inside + 1);
      const double b = length(all - arc + ends) * inverse / (outside + 1);
      const double fewer = std::min(inside, outside) + 2, more = std::max(inside, outside) + 2;
      double score = kUneven * (more - fewer);
      score += kFew * (std::max(0.0, 5 - fewer) + std::max(0.0, 5 - more));
      score += kThree * double(int(fewer == 3) + int(more == 3));
      score += kBusy * (ring[i].triangles + ring[j].triangles);
      score += kFar * inverse * (length(ring[i].position) + length(ring[j].position));
      score += kAside * inverse * 0.5 * length(ends);
      score += kNearChild * std::min(a, b) + kFarChild * std::max(a, b);
      pairs.push_back({i, j, score});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const RingPair& x, const RingPair& y) { return x.score > y.score; });
}

}  // namespace crease::codec
