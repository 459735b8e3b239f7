// What is far away costs, however small it is. Quadrics count by area: a lamp post, a finger or the
// tip of a branch has little of it and would vanish long before what is as deep and wide. So a
// contraction costs at least as much as if an area, the pass's far area, were as far from the
// surface as its farthest witness.
//
//   FarArea far_area;
//   steering.far_area = far_area.share() * triangle_area;  // of the mean triangle
//   far = max(witness's distance - kRounding, 0);          // in grid units
//   counts.add(steering.far_area * far * far / cost);      // of contractions near the limit
//   far_area.learn(counts);                                // after the pass
//
// What rounding to the grid moves does not count: on coarse grids all that is flat is as far away.
//
// How large that area may be depends on the model: of a scan's cost most is its normals', of a
// city's the distance of what is small and vanishes; with one share for both either the scan loses
// its fingers or the city's walls stay triangles short. So each pass learns from the last one: the
// share is such that it would have raised the cost of one contraction in twenty. The first one,
// which is half of the model, begins with what others mostly learn: 1 to 8.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace crease::simplification {

// A vertex that was rounded, and a surface through some, are off by less; grid units.
inline constexpr double kRounding = 1;

// How many ratios there are of each size, in steps of a fifth to a quarter: sums that do not depend
// on the order in which they come.
class FarCounts {
 public:
  void add(double ratio) {
    const float near = static_cast<float>(std::min(ratio, 1e9));
    const std::uint32_t step = std::bit_cast<std::uint32_t>(near) >> kShift;
    ++counts_[std::clamp(step, kFirst, kFirst + kSteps - 1) - kFirst];
  }
  void add(const FarCounts& o) {
    for (std::size_t i = 0; i < kSteps; ++i) counts_[i] += o.counts_[i];
  }
  std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (std::uint32_t count : counts_) sum += count;
    return sum;
  }
  // The least ratio of the step in which the `rank`-th of them is, the lowest first.
  double at_rank(std::uint64_t rank) const {
    std::uint32_t i = 0;
    for (; i + 1 < kSteps && rank >= counts_[i]; ++i) rank -= counts_[i];
    return double(std::bit_cast<float>((kFirst + i) << kShift));
  }

 private:
  // A float's exponent and the first two bits after it, from 2^-16 to 2^16.
  static constexpr std::uint32_t kShift = 21, kSteps = 128, kFirst = (127 - 16) << 2;
  std::array<std::uint32_t, kSteps> counts_{};
};

class FarArea {
 public:
  // Of the mean triangle's area.
  double share() const { return share_; }

  // `counts`: what the far area alone would have had contractions cost, beside what they did.
  void learn(const FarCounts& counts) {
    const std::uint64_t total = counts.total();
    if (total < kFew) return;
    share_ = std::clamp(share_ / counts.at_rank(total - total / kOneIn), kLeast, kMost);
  }

 private:
  static constexpr std::uint64_t kFew = 64, kOneIn = 20;
  // With more of it than kMost levels of scans are nearer still, but their normals are worse.
  static constexpr double kLeast = 0.25, kMost = 8;
  double share_ = 6;
};

}  // namespace crease::simplification
