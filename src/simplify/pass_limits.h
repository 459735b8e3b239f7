// How far a pass goes: the cost that no contraction of it exceeds, such that about the same share
// of the triangles stays each time.
//
// The share that stays falls with a power of the factor by which the limit grew. That power is
// another one for a band's first pass, whose borders are new, than for those that follow, whose
// borders kept everything near them from going: each is learned from the last such pass.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace crease::simplification {

// A pass should leave about this share of its triangles. A band is one or more passes over the same
// patches, each with quadrics anew: fewer bands make smaller files, which hold what all bands begin
// with, but the patches' borders stay where they are.
inline constexpr double kPassShare = 0.5;
inline constexpr int kPasses = 2;
inline constexpr int kPassesOfFirst = 1;  // so that half of the triangles see two borders

// By no more than this, though more triangles stay. Beyond it, what lies within a patch goes before
// what costs far less and lies at its border: the walls of a building before its pipes.
inline constexpr double kMostGrowth = 24;

class PassLimits {
 public:
  explicit PassLimits(double first) : limit_(first) {}

  // area * squared length, grid units
  double limit() const { return limit_; }
  bool begins_band() const { return pass_ == 0; }

  // Where nothing cost so little.
  void raise(double limit) { limit_ = std::max(limit_, limit); }

  // After a pass. True: it was its band's last, as it is where `cut_short`.
  bool advance(double share, bool cut_short) {
    double& power = powers_[static_cast<std::size_t>(pass_)];
    if (factor_ > 1) {
      power = std::clamp(-std::log(std::min(share, 0.97)) / std::log(factor_), 0.12, 1.0);
    }
    const bool ends = cut_short || pass_ + 1 == (is_first_band_ ? kPassesOfFirst : kPasses);
    is_first_band_ = is_first_band_ && !ends;
    pass_ = ends ? 0 : pass_ + 1;
    const double next = powers_[static_cast<std::size_t>(pass_)];
    factor_ = std::clamp(std::pow(kPassShare, -1 / next), 2.0, kMostGrowth);
    limit_ *= factor_;
    return ends;
  }

 private:
  double limit_, factor_ = 1;
  int pass_ = 0;
  bool is_first_band_ = true;
  std::array<double, kPasses> powers_{0.35, 0.25};  // of scans and CAD models
};

}  // namespace crease::simplification
