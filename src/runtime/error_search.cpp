#include "runtime/error_search.h"

#include <algorithm>
#include <cmath>

namespace crease {

namespace {

constexpr double kNear = 1.01;         // of two errors: nothing between them is looked for
constexpr double kMostOfThem = 0.99;   // so many triangles are as good as all
constexpr double kMostInFlight = 0.9;  // and these while the view changes, which changes them too
constexpr double kLargestStep = 4;

double ratio(std::size_t a, std::size_t b) {
  return static_cast<double>(a) / static_cast<double>(std::max<std::size_t>(b, 1));
}

}  // namespace

// What was found for a view before this one is where to begin, unless that had hardly any
// triangles.
void ErrorSearch::look_anew(std::size_t max_triangles) {
  good_ = std::min(good_, kFirst);
  too_fine_ = 0;
  has_ended_ = false;
  const bool has_room = ratio(triangles_, max_triangles) < kMostInFlight;
  trial_ = has_room ? finer(max_triangles) : good_;
}

double ErrorSearch::coarser(double error, std::size_t triangles, std::size_t max_triangles) {
  return error * std::clamp(ratio(triangles, max_triangles), 1.02, kLargestStep);
}

// There are about as many times more triangles as errors are smaller, or somewhat more.
double ErrorSearch::finer(std::size_t max_triangles) const {
  const double step = std::clamp(ratio(triangles_, max_triangles), 1 / kLargestStep, 1 / kNear);
  return std::max({1.0, good_ * step, std::sqrt(good_ * too_fine_)});
}

void ErrorSearch::tell(double error, std::size_t triangles, std::size_t max_triangles,
                       bool is_complete) {
  good_ = error;
  triangles_ = triangles;
  if (!is_complete) return;
  if (error > trial_) too_fine_ = std::max(too_fine_, trial_);
  has_ended_ =
      good_ <= 1 || good_ <= too_fine_ * kNear || ratio(triangles, max_triangles) >= kMostOfThem;
  trial_ = has_ended_ ? good_ : finer(max_triangles);
}

}  // namespace crease
